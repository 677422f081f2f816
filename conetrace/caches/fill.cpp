#include "conetrace/caches/fill.h"

#include "conetrace/lrsm/march_slab_batch.h"
#include "core/base/parallel.h"

#include <memory>

namespace lrsm {
namespace {

constexpr std::size_t kBatchesPerTask = 8;

/// Cones are numbered cache by cache, texel by texel; a batch is the next kBatchCones of them.
class CacheBatch {
  public:
    CacheBatch(const CachePlaces& places, const CacheTables& tables, const BatchWorld& world)
        : places_(places), tables_(tables), world_(world), texels_(tables.texels())
    {
    }

    void march(MarchBatch kernel, const MarchSchedule& schedule, std::size_t first, std::size_t end, ConeCounts& counts)
    {
        cones_->count = static_cast<int>(end - first);
        for (std::size_t i = first; i < end; ++i) place(static_cast<int>(i - first), i / texels_, i % texels_);
        kernel(world_, schedule, *cones_, *scratch_, *result_, counts);
    }
    Vec4 texel(std::size_t cone) const
    {
        const float* radiance = result_->radiance[cone];
        return {radiance[0], radiance[1], radiance[2], result_->opacity[cone]};
    }

  private:
    void place(int cone, std::size_t cache, std::size_t texel)
    {
        const VoxelGrid& grid = world_.cones.opacity.base.grid;
        const Vec3& normal = places_.normals[cache];
        const Vec3 origin = places_.positions[cache] + normal * (world_.cones.settings.march.normalOffsetVoxels * grid.voxelSize);
        cones_->setOrigin(cone, grid.voxelsFromWorld(origin), origin);
        cones_->setDirection(cone, basisFromNormal(normal) * tables_.directions[places_.rotations[cache] * texels_ + texel]);
    }

    const CachePlaces& places_;
    const CacheTables& tables_;
    const BatchWorld& world_;
    std::size_t texels_;
    std::unique_ptr<ConeBatch> cones_ = std::make_unique_for_overwrite<ConeBatch>();
    std::unique_ptr<MarchBatchScratch> scratch_ = std::make_unique_for_overwrite<MarchBatchScratch>();
    std::unique_ptr<ConeBatchResult> result_ = std::make_unique_for_overwrite<ConeBatchResult>();
};

}  // namespace

ConeSettings slabSettings(const ConeSettings& settings)
{
    ConeSettings own = settings;
    own.march.estimator = Estimator::slab;
    return own;
}

MarchSchedule texelSchedule(const CacheSettings& settings, const ConeSettings& cones, int gridResolution)
{
    return makeSchedule(cones, texelTanHalf(settings.resolution, cones.set.apertureScale), gridDiagonal(gridResolution));
}

GatherPlan planCaches(const CacheSettings& settings, const ConeSettings& cones, int gridResolution)
{
    CacheTables tables = makeCacheTables(settings, cones.set.rotation);
    GatherPlan plan;
    plan.cones.count = static_cast<int>(tables.texels());
    plan.cones.directions = std::move(tables.directions);
    plan.ringSchedules = {texelSchedule(settings, slabSettings(cones), gridResolution)};
    plan.cones.rings = {
        {.count = plan.cones.count, .outerAngle = 0.5f * kPi, .tanHalf = plan.ringSchedules[0].tanHalf, .weight = 1.0f / static_cast<float>(plan.cones.count)}};
    return plan;
}

CacheAtlas fillFromLrsm(const CachePlaces& places, const CacheTables& tables, const ConeWorld& world, const CacheSettings& settings, int lanes)
{
    const MarchSchedule schedule = texelSchedule(settings, world.settings, world.opacity.base.grid.resolution);
    const BatchWorld batchWorld(world);
    const MarchBatch kernel = marchSlabBatch(lanes);
    CacheAtlas atlas;
    atlas.resolution = settings.resolution;
    atlas.preExposure = 1.0f / unexposed(world.lrsms);
    atlas.half = settings.storage == Storage::gpu;
    atlas.levels.emplace_back(places.size() * tables.texels());
    std::vector<Vec4>& texels = atlas.levels[0];

    struct Counts {
        ConeCounts cones;
        ConversionCounts conversions;
    };
    const std::size_t batches = (texels.size() + kBatchCones - 1) / kBatchCones;
    std::vector<Counts> partial(batches / kBatchesPerTask + 1);
    parallelFor(batches, kBatchesPerTask, [&](std::size_t begin, std::size_t end) {
        CacheBatch batch(places, tables, batchWorld);
        Counts& counts = partial[begin / kBatchesPerTask];
        for (std::size_t b = begin; b < end; ++b) {
            const std::size_t first = b * kBatchCones, last = std::min(texels.size(), first + kBatchCones);
            batch.march(kernel, schedule, first, last, counts.cones);
            for (std::size_t i = first; i < last; ++i) texels[i] = storedTexel(batch.texel(i - first), settings, counts.conversions);
        }
    });
    for (const Counts& counts : partial) {
        atlas.cones += counts.cones;
        atlas.conversions += counts.conversions;
    }
    return atlas;
}

}  // namespace lrsm
