#include "voxel/radiance/isotropic_volume.h"

#include <algorithm>

namespace lrsm {
namespace {

/// Of a cube of eight voxels a wall fills four.
constexpr float kWallShare = 1.0f / 4.0f;

Vec4 coverage(const std::vector<Vec4>& finer, const TexelChildren& at)
{
    const Vec4 sum = ((finer[at[0]] + finer[at[1]]) + (finer[at[2]] + finer[at[3]])) + ((finer[at[4]] + finer[at[5]]) + (finer[at[6]] + finer[at[7]]));
    if (!(sum.w > 0.0f)) return Vec4(0.0f);
    const float a = std::min(1.0f, kWallShare * sum.w);
    return Vec4(Vec3(sum) * (a / sum.w), a);
}

}  // namespace

std::size_t IsotropicVolume::predictGpuBytes(int resolution)
{
    std::size_t bytes = 0;
    for (int n = resolution; n >= 1; n /= 2) bytes += denseGpuBytes(n);
    return bytes;
}

Counters countersOf(const IsotropicVolume& volume)
{
    std::size_t bricks = 0;
    for (const BrickMap& map : volume.maps) bricks += map.coordinate.size() - 1;
    return {{.name = "bricks_held", .value = double(bricks), .describes = true},
            {"half_saturations", double(volume.conversions.halfSaturations)},
            {"nans", double(volume.conversions.nans)}};
}

void prefilterRadiance(IsotropicVolume& volume, const CacheSettings& settings)
{
    volume.levels.resize(volume.maps.size());
    for (std::size_t level = 1; level < volume.maps.size(); ++level) prefilterRadianceLevel(volume, level, settings);
}

void prefilterRadianceLevel(IsotropicVolume& volume, std::size_t level, const CacheSettings& settings)
{
    const BrickMap &map = volume.maps[level], &below = volume.maps[level - 1];
    const std::vector<Vec4>& finer = volume.levels[level - 1];
    std::vector<Vec4>& texels = volume.levels[level];
    texels.assign(map.texelCount(), Vec4(0.0f));
    forCountedTexels(map, volume.conversions, [&](const IVec3& texel, std::size_t at, ConversionCounts& counts) {
        texels[at] = storedTexel(coverage(finer, childrenOf(below, texel)), settings.storage, settings.halfRounding, counts);
    });
}

}  // namespace lrsm
