#include "conetrace/frame/world.h"

#include "conetrace/frame/shadow_map.h"
#include "core/base/hash.h"
#include "core/scene/exposure.h"
#include "core/scene/scene_hash.h"

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

void buildVoxels(World& world, const SceneKeys* keys, const Scene& scene, const Settings& settings, const WorldReads& reads, PassLog& log)
{
    const bool mips = reads.mips || settings.direct.shadows == Shadows::cone;
    if (!mips && !reads.bits) return;
    const bool kept = keepOrMake(world.opacityMade, world.geometry, log, [&] {
        world.opacity = {};
        world.opacity.base = log.run("voxelize", mips ? kPassedOn : kWorldPass, [&] {
            return keys ? voxelizeAfter(world.standing, scene, keys->meshes, settings.voxel) : voxelize(scene, settings.voxel);
        });
        if (mips) world.opacity = log.run("voxel mips", kWorldPass, [&] { return buildPyramid(std::move(world.opacity.base), settings.voxel); });
    });
    if (!kept) return;
    log.show("voxelize", world.opacity.base);
    if (mips) log.show("voxel mips", world.opacity);
}

/// One map a light: those whose keys hold stay.
template <class Map, class Make>
void buildMaps(std::vector<Map>& maps, std::vector<Made>& made, const std::vector<std::string>& keys, const std::string& family, PassLog& log, const Make& make)
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

void buildWorld(World& world, bool keeps, const Scene& scene, const Requirements& needs, const Settings& settings, const WorldReads& reads, PassLog& log)
{
    std::optional<SceneKeys> keys;
    std::vector<std::string> mapKeys(scene.lights.size());
    if (keeps) {
        keys = keysOf(scene);
        meetMoment(world, scene, *keys, settings);
        const float preExposure = preExposureOf(scene);
        for (std::size_t i = 0; i < mapKeys.size(); ++i) mapKeys[i] = mapKey(world, keys->lights[i], preExposure);
    }
    buildVoxels(world, keys ? &*keys : nullptr, scene, settings, reads, log);
    buildMaps(world.rsms, world.rsmsMade, mapKeys, "rsm", log,
              [&](std::size_t i) { return renderRsm(scene, scene.lights[i], needs, settings.rsm, settings.surface.textureFilter); });
    if (!hasShadowMaps(settings.direct)) return;
    buildMaps(world.shadowMaps, world.shadowMapsMade, mapKeys, "shadow", log,
              [&](std::size_t i) { return renderDepthMap(scene, scene.lights[i], needs, refine(world.rsms[i].projection, settings.direct.shadowResolution)); });
}

}  // namespace lrsm
