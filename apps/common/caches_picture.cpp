#include "apps/common/caches_picture.h"

#include <algorithm>

namespace lrsm {

namespace {

constexpr int kGap = 4;  ///< rows between the two parts
constexpr Rgb8 kDot{255, 255, 255}, kBackground{16, 16, 16};

/// A colour for a number: the bits of Fibonacci hashing, none of them dark.
Rgb8 colourOf(std::uint32_t cluster)
{
    const std::uint32_t bits = cluster * 2654435769u;
    const auto channel = [&](int shift) { return static_cast<std::uint8_t>(48 + ((bits >> shift) & 127)); };
    return {channel(8), channel(16), channel(24)};
}

void drawClusters(const Caches& caches, Image<Rgb8>& picture)
{
    const Image<std::uint32_t>& clusterOf = caches.clusters.clusterOf;
    for (std::size_t i = 0; i < clusterOf.texels.size(); ++i)
        if (clusterOf.texels[i] > 0) picture.texels[i] = colourOf(clusterOf.texels[i]);
    // A cross is seen where a pixel is not.
    for (const std::uint32_t pixel : caches.places.pixels) {
        const auto x = static_cast<int>(pixel) % clusterOf.width, y = static_cast<int>(pixel) / clusterOf.width;
        for (const auto& [dx, dy] : {std::pair(0, 0), std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
            if (x + dx >= 0 && y + dy >= 0 && x + dx < clusterOf.width && y + dy < clusterOf.height) picture.at(x + dx, y + dy) = kDot;
    }
}

/// Radiance of the first caches that `columns` x `rows` have room for.
Image<Vec3> atlasOf(const CacheAtlas& atlas, int columns, int rows)
{
    const int n = atlas.resolution;
    Image<Vec3> radiance(columns * n, rows * n);
    const std::size_t shown = std::min(atlas.caches(), std::size_t(columns) * std::size_t(rows));
    for (std::size_t cache = 0; cache < shown; ++cache)
        for (int row = 0; row < n; ++row)
            for (int column = 0; column < n; ++column) {
                const Vec4& texel = atlas.levels[0][cache * std::size_t(n * n) + std::size_t(row * n + column)];
                radiance.at(int(cache) % columns * n + column, int(cache) / columns * n + row) = Vec3(texel) / atlas.preExposure;
            }
    return radiance;
}

}  // namespace

Image<Rgb8> cachesPicture(const Caches& caches, float exposureStops)
{
    const int width = caches.clusters.clusterOf.width, height = caches.clusters.clusterOf.height, n = caches.atlas.resolution;
    const int columns = std::max(1, width / n), most = std::max(1, height / n);
    const int rows = std::min(most, static_cast<int>((caches.atlas.caches() + std::size_t(columns) - 1) / std::size_t(columns)));
    Image<Rgb8> picture(std::max(width, columns * n), height + kGap + rows * n, kBackground);
    drawClusters(caches, picture);
    if (caches.atlas.caches() == 0) return picture;
    const Image<Rgb8> atlas = tonemap(atlasOf(caches.atlas, columns, rows), exposureStops);
    for (int y = 0; y < atlas.height; ++y)
        for (int x = 0; x < atlas.width; ++x) picture.at(x, height + kGap + y) = atlas.at(x, y);
    return picture;
}

}  // namespace lrsm
