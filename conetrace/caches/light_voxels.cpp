#include "conetrace/caches/light_voxels.h"

#include "conetrace/frame/direct.h"
#include "conetrace/vct/light_surfels.h"
#include "core/base/elementary.h"
#include "core/base/memory.h"
#include "core/scene/exposure.h"

namespace lrsm {
namespace {

std::vector<VoxelLight> lit(const GatherInput& input, const VoxelSurface& surface, float preExposure)
{
    const DirectSettings& direct = input.settings.direct;
    std::vector<VoxelLight> lights(surface.index.count());
    if (input.settings.caches.shadow == CacheShadow::rsm) {
        const std::vector<DepthMapView> depths(input.rsms.begin(), input.rsms.end());
        lightSurfels(input, surface, preExposure, lights, [&](std::size_t light, const ShadowReceiver& receiver, const LightSample&) {
            return shadowFromMap(depths[light], receiver, direct.depthBiasTexels);
        });
        return lights;
    }
    const float tanHalf = shadowConeTanHalf(direct);
    lightSurfels(input, surface, preExposure, lights, [&](std::size_t, const ShadowReceiver& receiver, const LightSample& light) {
        return shadowFromCone(input.opacity, receiver.position, receiver.geometricNormal, light.toLight, light.distance, tanHalf);
    });
    return lights;
}

}  // namespace

IsotropicVolume lightVoxels(const GatherInput& input, const VoxelSurface& surface)
{
    const BitGrid& bits = input.opacity.base;
    const CacheSettings& settings = input.settings.caches;
    IsotropicVolume volume;
    volume.preExposure = preExposureOf(input.scene);
    volume.maps = mapBricks(bits);
    requireMemory(predictIsotropicBytes(volume.maps), "lit voxels", "lower voxel_resolution");
    const std::vector<VoxelLight> lights = lit(input, surface, volume.preExposure);
    const BrickMap& map = volume.maps.front();
    std::vector<Vec4>& texels = volume.levels.emplace_back(map.texelCount(), Vec4(0.0f));
    for (std::size_t place = 1; place < map.coordinate.size(); ++place) {
        const std::size_t brick = map.coordinate[place];
        forEachBit(bits.bricks[brick], [&](int bit) {
            const Vec4 texel(lights[surface.index.at(bits, brick, bit)].radiance, 1.0f);
            texels[place * BrickMap::kTexels + std::size_t(bit)] = storedTexel(texel, settings.storage, settings.halfRounding, volume.conversions);
        });
    }
    return volume;
}

}  // namespace lrsm
