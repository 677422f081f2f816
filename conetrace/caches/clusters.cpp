#include "conetrace/caches/clusters.h"

#include "conetrace/frame/tiles.h"
#include "core/base/elementary.h"
#include "core/base/parallel.h"
#include "core/scene/camera.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace {

constexpr std::size_t kTilesAtOnce = 8;
constexpr float kMostSlices = float(1 << (32 - kSliceShift - 3));  // so that a slice fits into its key

/// Cluster's key above, pixel below: sorting gives clusters in order of their keys, pixels in the picture's order.
using Entry = std::uint64_t;

Entry entryOf(std::uint32_t key, std::size_t pixel)
{
    return Entry(key) << 32 | Entry(pixel);
}
std::uint32_t keyOf(Entry entry)
{
    return static_cast<std::uint32_t>(entry >> 32);
}

/// A run of one key: a cluster.
struct Group {
    std::size_t begin = 0, end = 0;
};

struct TileClusters {
    NormalAxes axes{};
    std::vector<Entry> entries;  ///< sorted
    std::vector<Group> groups;   ///< of them
};

std::vector<Group> groupsOf(const std::vector<Entry>& entries)
{
    std::vector<Group> groups;
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (i == 0 || keyOf(entries[i]) != keyOf(entries[i - 1]))
            groups.push_back({i, i + 1});
        else
            groups.back().end = i + 1;
    return groups;
}

/// Clusters of fewer than `least` pixels join the tile's nearest in depth, of those that have as many, on the same side of the same axis (ties: the nearer to
/// the eye).
void joinSmall(std::vector<Entry>& entries, std::size_t least)
{
    constexpr std::uint32_t kAxisMask = (1u << kSliceShift) - 1;
    const std::vector<Group> groups = groupsOf(entries);
    std::vector<Entry> joined = entries;
    for (const Group& small : groups) {
        if (small.end - small.begin >= least) continue;
        const std::uint32_t key = keyOf(entries[small.begin]);
        std::uint32_t nearest = key, distance = ~0u;
        for (const Group& large : groups) {
            const std::uint32_t other = keyOf(entries[large.begin]);
            if (large.end - large.begin < least || ((other ^ key) & kAxisMask) != 0) continue;
            const std::uint32_t away = (other > key ? other - key : key - other) >> kSliceShift;
            if (!(away < distance)) continue;
            distance = away;
            nearest = other;
        }
        for (std::size_t i = small.begin; i < small.end; ++i) joined[i] = entryOf(nearest, static_cast<std::uint32_t>(entries[i]));
    }
    std::sort(joined.begin(), joined.end());
    entries = std::move(joined);
}

class TileClusterer {
  public:
    TileClusterer(const GBuffer& gbuffer, const Camera& camera, int tile, int minPixels)
        : gbuffer_(gbuffer), tile_(tile), least_(std::size_t(minPixels)), slices_(camera, gbuffer.height, tile)
    {
    }

    TileClusters operator()(int tileX, int tileY) const
    {
        TileClusters out;
        // Histogram of the shading normals.
        std::array<std::uint32_t, kNormalBins * kNormalBins> counts{};
        forCoveredPixels(tileX, tileY, [&](std::size_t pixel) { ++counts[std::size_t(normalBin(gbuffer_.normal.texels[pixel]))]; });
        out.axes = finder_.axesOf(counts);

        // A key a pixel; sorted.
        forCoveredPixels(tileX, tileY, [&](std::size_t pixel) {
            const auto axis = static_cast<std::uint32_t>(axisOf(gbuffer_.normal.texels[pixel], out.axes));
            out.entries.push_back(entryOf(slices_(gbuffer_.depthLinear.texels[pixel]) << kSliceShift | axis, pixel));
        });
        if (out.entries.empty()) out.axes = {};
        std::sort(out.entries.begin(), out.entries.end());
        if (least_ > 0) joinSmall(out.entries, least_);
        out.groups = groupsOf(out.entries);
        return out;
    }

  private:
    template <class Visit>
    void forCoveredPixels(int tileX, int tileY, const Visit& visit) const
    {
        const int xEnd = std::min(gbuffer_.width, (tileX + 1) * tile_), yEnd = std::min(gbuffer_.height, (tileY + 1) * tile_);
        for (int y = tileY * tile_; y < yEnd; ++y)
            for (int x = tileX * tile_; x < xEnd; ++x) {
                const std::size_t pixel = gbuffer_.position.index(x, y);
                if (gbuffer_.covered(pixel)) visit(pixel);
            }
    }

    const GBuffer& gbuffer_;
    int tile_;
    std::size_t least_;
    DepthSlices slices_;
    NormalAxisFinder finder_;
};

/// Prefix sums over the tiles, then every tile writes its own.
PixelClusters compact(const GBuffer& gbuffer, const std::vector<TileClusters>& tiles, int tile, int tilesX, int tilesY)
{
    PixelClusters out;
    out.tile = tile;
    out.tilesX = tilesX;
    out.tilesY = tilesY;
    out.clusterOf = Image<std::uint32_t>(gbuffer.width, gbuffer.height);
    out.tileFirst = {0};
    std::vector<std::size_t> firstPixel = {0};
    for (const TileClusters& one : tiles) {
        out.axes.push_back(one.axes);
        out.tileFirst.push_back(out.tileFirst.back() + static_cast<std::uint32_t>(one.groups.size()));
        firstPixel.push_back(firstPixel.back() + one.entries.size());
    }
    out.keys.resize(out.tileFirst.back());
    out.first.resize(out.keys.size() + 1);
    out.first.back() = static_cast<std::uint32_t>(firstPixel.back());
    out.pixels.resize(firstPixel.back());
    parallelFor(tiles.size(), kTilesAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const std::vector<Entry>& entries = tiles[t].entries;
            std::size_t cluster = out.tileFirst[t];
            for (const Group& group : tiles[t].groups) {
                out.keys[cluster] = keyOf(entries[group.begin]);
                out.first[cluster++] = static_cast<std::uint32_t>(firstPixel[t] + group.begin);
                for (std::size_t i = group.begin; i < group.end; ++i) {
                    const auto pixel = static_cast<std::uint32_t>(entries[i]);
                    out.pixels[firstPixel[t] + i] = pixel;
                    out.clusterOf.texels[pixel] = static_cast<std::uint32_t>(cluster);
                }
            }
        }
    });
    return out;
}

}  // namespace

DepthSlices::DepthSlices(const Camera& camera, int pictureHeight, int tile) : perspective_(camera.perspective), nearPlane_(camera.nearPlane)
{
    const double tileHeight = double(glm::length(pixelSpacing(camera, pictureHeight).down)) * tile;  // at one metre
    scale_ = static_cast<float>(perspective_ ? 1.0 / log2Exact(1.0 + tileHeight) : 1.0 / tileHeight);
}

std::uint32_t DepthSlices::operator()(float depth) const
{
    const float slice = perspective_ ? fastLog2(std::max(1.0f, depth / nearPlane_)) * scale_ : depth * scale_;
    return static_cast<std::uint32_t>(std::clamp(slice, 0.0f, kMostSlices));
}

PixelClusters clusterPixels(const GBuffer& gbuffer, const Camera& camera, const CacheSettings& settings)
{
    for (int doublings = 0;; ++doublings) {
        const int tile = settings.tile << doublings;
        const int tilesX = tilesAlong(gbuffer.width, tile), tilesY = tilesAlong(gbuffer.height, tile);
        std::vector<TileClusters> tiles(std::size_t(tilesX) * std::size_t(tilesY));
        const TileClusterer cluster(gbuffer, camera, tile, settings.minPixels);
        parallelFor(tiles.size(), kTilesAtOnce, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) tiles[t] = cluster(static_cast<int>(t) % tilesX, static_cast<int>(t) / tilesX);
        });
        std::uint64_t count = 0;
        for (const TileClusters& one : tiles) count += one.groups.size();
        // One tile cannot be doubled.
        if (count <= std::uint64_t(settings.maxCaches) || tiles.size() == 1) {
            PixelClusters clusters = compact(gbuffer, tiles, tile, tilesX, tilesY);
            clusters.doublings = doublings;
            return clusters;
        }
    }
}

Counters countersOf(const PixelClusters& clusters)
{
    return {{"caches", static_cast<double>(clusters.size())},
            {"clustered_pixels", static_cast<double>(clusters.pixels.size())},
            {"tile_doublings", static_cast<double>(clusters.doublings)},
            {.name = "rc_tile", .value = static_cast<double>(clusters.tile), .describes = true}};
}

}  // namespace lrsm
