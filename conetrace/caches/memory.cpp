#include "conetrace/caches/memory.h"

#include "conetrace/caches/atlas.h"
#include "conetrace/caches/clusters.h"
#include "conetrace/caches/places.h"
#include "conetrace/frame/tiles.h"
#include "conetrace/lrsm/memory.h"
#include "conetrace/vct/memory.h"
#include "voxel/radiance/isotropic_volume.h"

namespace lrsm {
namespace {

/// What the clusters' sizes follow from.
struct Clustered {
    std::size_t caches = 0, covered = 0, tiles = 0, pixels = 0;
    /// PixelClusters: axes; ranges of tiles; keys and ranges of clusters; sorted pixels; the cluster of each pixel.
    std::size_t bytes() const { return tiles * sizeof(NormalAxes) + ((tiles + 1) + caches + (caches + 1) + covered + pixels) * sizeof(std::uint32_t); }
};

/// As rendered, or the most that can be: a cluster has a pixel.
Clustered clusteredOf(const MemoryQuestion& question)
{
    const CacheSettings& settings = question.settings.caches;
    Clustered out;
    out.pixels = std::size_t(question.width) * std::size_t(question.height);
    int tile = settings.tile;
    const PassReport* found = nullptr;
    if (question.rendered)
        for (const PassReport& report : *question.rendered)
            if (report.name == "rc clusters") found = &report;
    if (found) {
        out.caches = static_cast<std::size_t>(counterSum(found->counters, "caches"));
        out.covered = static_cast<std::size_t>(counterSum(found->counters, "clustered_pixels"));
        tile = static_cast<int>(counterSum(found->counters, "rc_tile"));
    } else if (question.unknowns != Unknowns::least) {
        out.caches = std::min(std::size_t(settings.maxCaches), out.pixels);
        out.covered = out.pixels;
    }
    out.tiles = std::size_t(tilesAlong(question.width, tile)) * std::size_t(tilesAlong(question.height, tile));
    return out;
}

/// What fills the caches.
std::vector<MemoryRow> predictFill(const MemoryQuestion& question)
{
    switch (question.settings.caches.fill) {
    case CacheFill::lrsm: return predictLrsms(question);
    case CacheFill::vct: return predictRadiance(question);
    case CacheFill::voxels: break;
    }
    const int n = question.settings.voxel.resolution;
    return {{.structure = "lit voxels",
             .pass = "rc mips",
             .detail = std::to_string(n) + "^3, isotropic",
             .predicted = predictHeldBricks(question, 1, 1),
             .predictedGpu = IsotropicVolume::predictGpuBytes(n),
             .table2 = "",
             .measured = {}}};
}

}  // namespace

std::vector<MemoryRow> predictCaches(const MemoryQuestion& question)
{
    const CacheSettings& settings = question.settings.caches;
    const Clustered clustered = clusteredOf(question);
    const std::size_t caches = clustered.caches;
    const std::string count = std::string(question.rendered ? "" : "up to ") + std::to_string(caches) + " caches";
    constexpr std::size_t kPlaceBytes = 2 * sizeof(std::uint32_t) + 2 * sizeof(Vec3) + sizeof(float), kFrameBytes = sizeof(Mat3);
    std::vector<MemoryRow> rows = predictFill(question);
    rows.push_back({.structure = "clusters",
                    .pass = "rc clusters",
                    .detail = count,
                    .predicted = clustered.bytes(),
                    .predictedGpu = clustered.bytes(),
                    .table2 = "",
                    .measured = {}});
    rows.push_back({.structure = "cache places",
                    .pass = "rc places",
                    .detail = count,
                    .predicted = caches * (kPlaceBytes + kFrameBytes),
                    .predictedGpu = caches * kPlaceBytes,
                    .table2 = "",
                    .measured = {}});
    rows.push_back({.structure = "caches",
                    .pass = "rc convolve",
                    .detail = count + " of " + std::to_string(settings.resolution) + "^2",
                    .predicted = caches * predictCacheBytes(settings.resolution),
                    .predictedGpu = caches * predictCacheGpuBytes(settings),
                    .table2 = "",
                    .measured = {}});
    return rows;
}

}  // namespace lrsm
