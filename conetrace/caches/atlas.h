#pragma once

#include "conetrace/caches/mapping.h"
#include "conetrace/frame/cone.h"
#include "core/base/arrays.h"
#include "core/base/formats.h"
#include "voxel/radiance/brick_map.h"

#include <cstdint>

/// What all caches see, pre-convolved: [SNRS12], Scherzer, Nguyen, Ritschel and Seidel, "Pre-convolved Radiance Caching", EGSR 2012.
namespace lrsm {

/// Texels are radiance times the pre-exposure, and opacity; values are representable in the storage that the settings name.
struct CacheAtlas {
    int resolution = 0;                     ///< N
    float preExposure = 1.0f;               ///< of the light maps
    bool half = true;                       ///< stored as R16G16B16A16F; else as float32
    std::vector<std::vector<Vec4>> levels;  ///< level l: [cache * (N >> l)^2 + row * (N >> l) + column]; as filled, level 0 alone
    std::vector<Vec4> diffuse;              ///< irradiance of a surface with normal m, and its hemisphere's opacity: [cache * kDiffuseNodes^2 + m]
    ConeCounts cones;
    ConversionCounts conversions;

    std::size_t caches() const { return resolution > 0 ? levels.at(0).size() / (std::size_t(resolution) * std::size_t(resolution)) : 0; }
};

template <class Visit>
void forEachArray(const CacheAtlas& atlas, Visit&& visit)
{
    const auto visitTexels = [&](const std::vector<Vec4>& texels) {
        visit(texels, ArrayTraits{texels.size() * 4 * (atlas.half ? sizeof(std::uint16_t) : sizeof(float))});
    };
    for (const std::vector<Vec4>& level : atlas.levels) visitTexels(level);
    if (!atlas.diffuse.empty()) visitTexels(atlas.diffuse);
}

Counters countersOf(const CacheAtlas& atlas);

/// As the texture holds it.
inline Vec4 storedTexel(const Vec4& value, const CacheSettings& settings, ConversionCounts& counts)
{
    return storedTexel(value, settings.storage, settings.halfRounding, counts);
}

/// Mips and table of irradiance from level 0 as it is stored. A mip's texel is the mean of its four by solid angle; irradiance is pi times the mean by
/// CacheTables::cosineShare.
CacheAtlas convolveCaches(CacheAtlas filled, const CacheTables& tables, const CacheSettings& settings);
/// One level of the mips from the one below, which is there.
void fillCacheLevel(CacheAtlas& atlas, int level, const CacheTables& tables, const CacheSettings& settings);
void foldCosine(CacheAtlas& atlas, const CacheTables& tables, const CacheSettings& settings);

/// Bytes of one cache with its mips and table, as held here and on a GPU.
std::size_t predictCacheBytes(int resolution);
std::size_t predictCacheGpuBytes(const CacheSettings& settings);

}  // namespace lrsm
