#include "conetrace/frame/world.h"

#include "conetrace/frame/memory.h"
#include "conetrace/frame/shadow_map.h"
#include "core/base/hash.h"
#include "core/scene/exposure.h"
#include "core/scene/scene_hash.h"
#include "voxel/cascades.h"

#include <optional>
#include <span>

namespace lrsm {
namespace {

/// Forgets what was made from other materials, textures or settings, and takes note of the moment's geometry.
void meetMoment(World& world, const Scene& scene, const SceneKeys& keys, const Settings& settings)
{
    // Textures never change, and those held here cannot make way for others at their address: the same pointers are the same textures.
    if (!(world.settings == settings && world.materials == keys.materials && world.textures == scene.textures)) {
        world = {};
        world.settings = settings, world.materials = keys.materials, world.textures = scene.textures;
    }
    Sha256 geometry;
    for (const std::string& mesh : keys.meshes) geometry.add(mesh);
    world.geometry = geometry.add(keys.boxes).hex();
}

/// A light's map hangs on the light, on all that it may shine on, and on the exposure that all lights share.
std::string mapKey(const World& world, const std::string& light, float preExposure)
{
    return Sha256().add(world.geometry + light).add(std::as_bytes(std::span(&preExposure, 1))).hex();
}

/// The voxels, coarsest cascade first. Each has its passes: those of a lone grid, the finer ones by number.
void buildVoxels(World& world, const SceneKeys* keys, const Scene& scene, const Camera& camera, const Settings& settings, const WorldReads& reads, PassLog& log)
{
    const bool mips = reads.mips || settings.direct.shadows == Shadows::cone;
    if (!mips && !reads.bits) return;
    const std::vector<VoxelGrid> grids = gridsOf(scene, settings.voxel, camera.position);
    const int cascades = settings.voxel.cascades;
    const auto cascadeOf = [&](int finer) { return std::size_t(cascades - 1 - finer); };
    world.standing.resize(grids.size());
    const std::string key = keys ? Sha256().add(world.geometry).add(std::as_bytes(std::span(grids))).hex() : "";
    const bool kept = keepOrMake(world.opacityMade, key, log, [&] {
        world.opacity = {};
        for (int finer = 0; finer < cascades; ++finer) {
            OpacityPyramid opacity;
            const VoxelGrid& grid = grids[cascadeOf(finer)];
            opacity.base = log.run("voxelize" + cascadeSuffix(finer), mips ? kPassedOn : kWorldPass, [&] {
                return keys ? voxelizeAfter(world.standing[cascadeOf(finer)], scene, keys->meshes, grid, settings.voxel.mode)
                            : voxelize(scene, grid, settings.voxel.mode);
            });
            if (mips) opacity = log.run("voxel mips" + cascadeSuffix(finer), kWorldPass, [&] { return buildPyramid(std::move(opacity.base), settings.voxel); });
            if (finer > 0) linkCascade(opacity, std::move(world.opacity));
            world.opacity = std::move(opacity);
        }
    });
    if (!kept) return;
    for (int finer = 0; finer < cascades; ++finer) {
        const OpacityPyramid& opacity = cascadeAt(world.opacity, int(cascadeOf(finer)));
        log.show("voxelize" + cascadeSuffix(finer), opacity.base);
        if (mips) log.show("voxel mips" + cascadeSuffix(finer), opacity);
    }
}

/// One map a light: those whose keys hold stay.
template <class Map, class Make>
void buildMaps(std::vector<Map>& maps, std::vector<MadeFrom>& made, const std::vector<std::string>& keys, const std::string& family, PassLog& log,
               const Make& make)
{
    maps.resize(keys.size());
    made.resize(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const std::string name = family + " " + std::to_string(i);
        const bool kept = keepOrMake(made[i], keys[i], log, [&] {
            maps[i] = {};
            maps[i] = log.run(name, kWorldPass, [&] { return make(i); });
        });
        if (kept) log.show(name, maps[i]);
    }
}

}  // namespace

void buildWorld(World& world, bool keeps, const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings,
                const WorldReads& reads, PassLog& log)
{
    std::optional<SceneKeys> keys;
    std::vector<std::string> mapKeys(scene.lights.size());
    if (keeps) {
        keys = keysOf(scene);
        meetMoment(world, scene, *keys, settings);
        const float preExposure = preExposureOf(scene);
        for (std::size_t i = 0; i < mapKeys.size(); ++i) mapKeys[i] = mapKey(world, keys->lights[i], preExposure);
    }
    buildVoxels(world, keys ? &*keys : nullptr, scene, camera, settings, reads, log);
    buildMaps(world.rsms, world.rsmsMade, mapKeys, "rsm", log,
              [&](std::size_t i) { return renderRsm(scene, scene.lights[i], needs, settings.rsm, settings.surface.textureFilter); });
    if (!hasShadowMaps(settings.direct)) return;
    buildMaps(world.shadowMaps, world.shadowMapsMade, mapKeys, "shadow", log,
              [&](std::size_t i) { return renderDepthMap(scene, scene.lights[i], needs, refine(world.rsms[i].projection, settings.direct.shadowResolution)); });
}

}  // namespace lrsm
