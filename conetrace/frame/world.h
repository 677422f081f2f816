#pragma once

#include "conetrace/frame/pass_log.h"
#include "core/scene/camera.h"
#include "core/scene/requirements.h"
#include "core/settings/settings.h"
#include "lrsm/depth_map.h"
#include "lrsm/rsm.h"
#include "voxel/opacity_pyramid.h"
#include "voxel/voxelize.h"

#include <any>
#include <string>
#include <vector>

/// What a frame is made from besides the eye: occlusion as voxels, light as maps. It may outlive its frame: the next one of a sequence then makes anew only
/// what was made from something else, and has the bits of a frame by itself.
namespace lrsm {

/// What of the voxels a method reads; the rest is not built. Layers and caches are its own passes.
struct WorldReads {
    bool bits = false;  ///< GatherInput::opacity.base
    bool mips = false;  ///< the levels above; implies the bits
};

/// Of some of the world: what it was made from, and what the passes that made it said.
struct MadeFrom {
    std::string key;  ///< equal only where all that the passes read is equal to the bit; empty: nothing that can be told again
    std::vector<PassReport> reports;
};

/// Runs `passes`, which log themselves and leave what they make where it is kept, unless it is there, made from the same: then their reports are repeated, with
/// no time, and the answer is true. Who is watching must then be shown it by the caller (PassLog::show).
template <class Passes>
bool keepOrMake(MadeFrom& made, const std::string& key, PassLog& log, Passes&& passes)
{
    if (!key.empty() && made.key == key) {
        log.repeat(made.reports);
        return true;
    }
    made = {};
    const std::size_t first = log.reports.size();
    std::forward<Passes>(passes)();
    made.key = key;
    made.reports.assign(log.reports.begin() + std::ptrdiff_t(first), log.reports.end());
    return false;
}

struct World {
    /// Where one of these changes nothing is kept.
    Settings settings;
    std::string materials;  ///< SceneKeys's
    std::vector<SharedTexture> textures;

    std::string geometry;                  ///< key of meshes, bounds and reach; empty where nothing outlives the frame
    std::vector<StandingVoxels> standing;  ///< one a cascade
    OpacityPyramid opacity;
    MadeFrom opacityMade;
    std::vector<Rsm> rsms;  ///< one a light, in the scene's order
    std::vector<MadeFrom> rsmsMade;
    std::vector<DepthMap> shadowMaps;  ///< where shadows are compared with finer depths than the RSMs'
    std::vector<MadeFrom> shadowMapsMade;
    std::any own;  ///< the method's (ownOf)

    std::vector<DepthMapView> depths() const
    {
        if (!shadowMaps.empty()) return {shadowMaps.begin(), shadowMaps.end()};
        return {rsms.begin(), rsms.end()};
    }
};

/// What the method keeps beside: a type of its own, new at first.
template <class Own>
Own& ownOf(World& world)
{
    Own* own = std::any_cast<Own>(&world.own);
    return own ? *own : world.own.emplace<Own>();
}

/// Fills `world` with what the scene's moment needs, voxels as far as `reads` and the direct light go. With `keeps` what stands from the last moment stays.
void buildWorld(World& world, bool keeps, const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings,
                const WorldReads& reads, PassLog& log);

}  // namespace lrsm
