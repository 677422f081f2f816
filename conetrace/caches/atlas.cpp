#include "conetrace/caches/atlas.h"

#include "core/base/parallel.h"

namespace lrsm {
namespace {

constexpr std::size_t kCachesPerTask = 32;
constexpr std::size_t kDiffuseCount = std::size_t(kDiffuseNodes) * std::size_t(kDiffuseNodes);

std::size_t texelsOfCache(int resolution)
{
    std::size_t texels = kDiffuseCount;
    for (int n = resolution; n >= 1; n /= 2) texels += std::size_t(n) * std::size_t(n);
    return texels;
}

/// body(cache, counts) for all caches; conversions are added in the order of chunks.
template <class Body>
void forCaches(CacheAtlas& atlas, const Body& body)
{
    const std::size_t caches = atlas.caches();
    std::vector<ConversionCounts> partial(caches / kCachesPerTask + 1);
    parallelFor(caches, kCachesPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cache = begin; cache < end; ++cache) body(cache, partial[begin / kCachesPerTask]);
    });
    for (const ConversionCounts& counts : partial) atlas.conversions += counts;
}

}  // namespace

Counters countersOf(const CacheAtlas& atlas)
{
    Counters counters;
    if (atlas.levels.size() == 1) counters = countersOf(atlas.cones);
    counters.push_back({"half_saturations", static_cast<double>(atlas.conversions.halfSaturations)});
    return counters;
}

void fillCacheLevel(CacheAtlas& atlas, int level, const CacheTables& tables, const CacheSettings& settings)
{
    const auto n = std::size_t(atlas.resolution >> level), below = 2 * n;
    const std::vector<float>& weights = tables.solidAngle[std::size_t(level) - 1];
    const std::vector<Vec4>& finer = atlas.levels[std::size_t(level) - 1];
    std::vector<Vec4>& texels = atlas.levels[std::size_t(level)];
    texels.assign(atlas.caches() * n * n, Vec4(0.0f));
    forCaches(atlas, [&](std::size_t cache, ConversionCounts& counts) {
        const Vec4* from = finer.data() + cache * below * below;
        for (std::size_t row = 0; row < n; ++row)
            for (std::size_t column = 0; column < n; ++column) {
                const std::size_t top = 2 * row * below + 2 * column, bottom = top + below;
                const Vec4 sum =
                    (weights[top] * from[top] + weights[top + 1] * from[top + 1]) + (weights[bottom] * from[bottom] + weights[bottom + 1] * from[bottom + 1]);
                const float whole = (weights[top] + weights[top + 1]) + (weights[bottom] + weights[bottom + 1]);
                texels[(cache * n + row) * n + column] = storedTexel(sum / whole, settings, counts);
            }
    });
}

void foldCosine(CacheAtlas& atlas, const CacheTables& tables, const CacheSettings& settings)
{
    const auto texels = std::size_t(atlas.resolution) * std::size_t(atlas.resolution);
    atlas.diffuse.assign(atlas.caches() * kDiffuseCount, Vec4(0.0f));
    forCaches(atlas, [&](std::size_t cache, ConversionCounts& counts) {
        const Vec4* from = atlas.levels[0].data() + cache * texels;
        for (std::size_t m = 0; m < kDiffuseCount; ++m) {
            const float* share = tables.cosineShare.data() + m * texels;
            Vec4 sum(0.0f);
            for (std::size_t i = 0; i < texels; ++i) sum += share[i] * from[i];
            atlas.diffuse[cache * kDiffuseCount + m] = storedTexel(Vec4(kPi * Vec3(sum), sum.w), settings, counts);
        }
    });
}

CacheAtlas convolveCaches(CacheAtlas filled, const CacheTables& tables, const CacheSettings& settings)
{
    filled.conversions = {};
    filled.levels.resize(std::size_t(tables.levels()));
    for (int level = 1; level < tables.levels(); ++level) fillCacheLevel(filled, level, tables, settings);
    foldCosine(filled, tables, settings);
    return filled;
}

std::size_t predictCacheBytes(int resolution)
{
    return texelsOfCache(resolution) * sizeof(Vec4);
}

std::size_t predictCacheGpuBytes(const CacheSettings& settings)
{
    return texelsOfCache(settings.resolution) * 4 * (settings.storage == Storage::gpu ? sizeof(std::uint16_t) : sizeof(float));
}

}  // namespace lrsm
