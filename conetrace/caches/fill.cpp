#include "conetrace/caches/fill.h"

#include "conetrace/lrsm/march_slab_batch.h"
#include "conetrace/vct/march_radiance_batch.h"
#include "core/base/elementary.h"
#include "core/base/parallel.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace lrsm {
namespace {

constexpr std::size_t kBatchesPerTask = 8;

struct FillCounts {
    ConeCounts cones;
    ConversionCounts conversions;
};

CacheAtlas emptyAtlas(const CachePlaces& places, const CacheTables& tables, float preExposure, const CacheSettings& settings)
{
    CacheAtlas atlas;
    atlas.resolution = settings.resolution;
    atlas.preExposure = preExposure;
    atlas.half = settings.storage == Storage::gpu;
    atlas.levels.emplace_back(places.size() * tables.texels());
    return atlas;
}

/// Cones are numbered cache by cache, texel by texel; a batch is the next kBatchCones of them.
template <class March>
class CacheBatch {
  public:
    /// march(cones, result, counts)
    CacheBatch(const CachePlaces& places, const CacheTables& tables, const VoxelGrid& grid, const MarchSettings& settings, March march)
        : places_(places), tables_(tables), grid_(grid), settings_(settings), march_(std::move(march)), texels_(tables.texels())
    {
    }

    void march(std::size_t first, std::size_t end, ConeCounts& counts)
    {
        cones_->count = static_cast<int>(end - first);
        for (std::size_t i = first; i < end; ++i) place(static_cast<int>(i - first), i / texels_, i % texels_);
        march_(*cones_, *result_, counts);
    }
    Vec4 texel(std::size_t cone, float exposure) const
    {
        const float* radiance = result_->radiance[cone];
        return {radiance[0] * exposure, radiance[1] * exposure, radiance[2] * exposure, result_->opacity[cone]};
    }

  private:
    void place(int cone, std::size_t cache, std::size_t texel)
    {
        const ConeRay ray = texelCone(places_, tables_, grid_, settings_, cache, texel);
        cones_->setOrigin(cone, ray.originVoxels, ray.originWorld, ray.receiverNormal);
        cones_->setDirection(cone, ray.direction);
    }

    const CachePlaces& places_;
    const CacheTables& tables_;
    const VoxelGrid& grid_;
    const MarchSettings& settings_;
    March march_;
    std::size_t texels_;
    std::unique_ptr<ConeBatch> cones_ = std::make_unique_for_overwrite<ConeBatch>();
    std::unique_ptr<ConeBatchResult> result_ = std::make_unique_for_overwrite<ConeBatchResult>();
};

/// Fills level 0; what is marched is stored times `exposure`. startTask() returns what marches a task's batches.
template <class StartTask>
void fillByBatches(CacheAtlas& atlas, const CachePlaces& places, const CacheTables& tables, const VoxelGrid& grid, const MarchSettings& settings,
                   float exposure, const CacheSettings& caches, const StartTask& startTask)
{
    std::vector<Vec4>& texels = atlas.levels[0];
    const std::size_t batches = (texels.size() + kBatchCones - 1) / kBatchCones;
    std::vector<FillCounts> partial(batches / kBatchesPerTask + 1);
    parallelFor(batches, kBatchesPerTask, [&](std::size_t begin, std::size_t end) {
        CacheBatch batch(places, tables, grid, settings, startTask());
        FillCounts& counts = partial[begin / kBatchesPerTask];
        for (std::size_t b = begin; b < end; ++b) {
            const std::size_t first = b * kBatchCones, last = std::min(texels.size(), first + kBatchCones);
            batch.march(first, last, counts.cones);
            for (std::size_t i = first; i < last; ++i) texels[i] = storedTexel(batch.texel(i - first, exposure), caches, counts.conversions);
        }
    });
    for (const FillCounts& counts : partial) {
        atlas.cones += counts.cones;
        atlas.conversions += counts.conversions;
    }
}

CacheAtlas fillByRadiance(const CachePlaces& places, const CacheTables& tables, const RadianceBatchWorld& world, const ConeSettings& cones,
                          const CacheSettings& settings, int lanes)
{
    const RadianceMarch& march = world.march;
    const MarchSchedule schedule = texelSchedule(settings, cones, march.grid.resolution);
    const RadianceMarchBatch kernel = marchRadianceBatch(lanes);
    CacheAtlas atlas = emptyAtlas(places, tables, march.preExposure, settings);
    fillByBatches(atlas, places, tables, march.grid, march.settings, march.preExposure, settings, [&] {
        return [&, scratch = std::make_unique_for_overwrite<RadianceBatchScratch>()](const ConeBatch& batch, ConeBatchResult& result, ConeCounts& counts) {
            kernel(world, schedule, batch, *scratch, result, counts);
        };
    });
    return atlas;
}

}  // namespace

ConeSettings slabSettings(const ConeSettings& settings)
{
    ConeSettings own = settings;
    own.march.estimator = Estimator::slab;
    return own;
}

ConeRay texelCone(const CachePlaces& places, const CacheTables& tables, const VoxelGrid& grid, const MarchSettings& march, std::size_t cache, std::size_t texel)
{
    const Vec3& normal = places.normals[cache];
    const Vec3 origin = places.positions[cache] + normal * (march.normalOffsetVoxels * grid.voxelSize);
    return {.originWorld = origin,
            .originVoxels = grid.voxelsFromWorld(origin),
            .direction = places.frames[cache] * tables.directions[places.rotations[cache] * tables.texels() + texel],
            .receiverNormal = normal};
}

MarchSchedule voxelSchedule(float tanHalf, float reachVoxels, int maxSteps)
{
    MarchSchedule schedule;
    schedule.tanHalf = tanHalf;
    const double growth = 2.0 * double(tanHalf), levels = log2Exact(1.0 + double(tanHalf));
    double t = 0.25 * double(kFirstDiameterVoxels), diameter = double(kFirstDiameterVoxels) + growth * t, level = log2Exact(diameter);
    while (t < double(reachVoxels) && static_cast<int>(schedule.steps.size()) < maxSteps) {
        const double length = 0.5 * diameter, used = std::max(0.0, level);
        MarchStep step;
        step.middle = step.begin = static_cast<float>(t);
        step.end = static_cast<float>(t + length);
        step.diameter = static_cast<float>(diameter);
        step.level = static_cast<float>(used);
        step.tapWidth = static_cast<float>(exp2Exact(used));
        schedule.steps.push_back(step);
        t += length;
        diameter += growth * length;
        level += levels;
    }
    return schedule;
}

MarchSchedule texelSchedule(const CacheSettings& settings, const ConeSettings& cones, int gridResolution)
{
    const float tanHalf = texelTanHalf(settings.resolution, cones.set.apertureScale), reach = gridDiagonal(gridResolution);
    if (settings.fill == CacheFill::voxels) return voxelSchedule(tanHalf, reach, cones.march.maxSteps);
    ConeSettings own = cones;
    own.march.estimator = settings.fill == CacheFill::vct ? Estimator::paper : Estimator::slab;
    return makeSchedule(own, tanHalf, reach);
}

GatherPlan planCaches(const CacheSettings& settings, const ConeSettings& cones, int gridResolution)
{
    CacheTables tables = makeCacheTables(settings, cones.set.rotation);
    GatherPlan plan;
    plan.cones.count = static_cast<int>(tables.texels());
    plan.cones.directions = std::move(tables.directions);
    plan.ringSchedules = {texelSchedule(settings, cones, gridResolution)};
    plan.cones.rings = {
        {.count = plan.cones.count, .outerAngle = 0.5f * kPi, .tanHalf = plan.ringSchedules[0].tanHalf, .weight = 1.0f / static_cast<float>(plan.cones.count)}};
    return plan;
}

CacheAtlas fillFromLrsm(const CachePlaces& places, const CacheTables& tables, const ConeWorld& world, const CacheSettings& settings, int lanes)
{
    const MarchSchedule schedule = texelSchedule(settings, world.settings, world.opacity.base.grid.resolution);
    const BatchWorld batchWorld(world);
    const MarchBatch kernel = marchSlabBatch(lanes);
    CacheAtlas atlas = emptyAtlas(places, tables, 1.0f / unexposed(world.lrsms), settings);
    constexpr float kAsMarched = 1.0f;
    fillByBatches(atlas, places, tables, world.opacity.base.grid, world.settings.march, kAsMarched, settings, [&] {
        return [&, scratch = std::make_unique_for_overwrite<MarchBatchScratch>()](const ConeBatch& batch, ConeBatchResult& result, ConeCounts& counts) {
            kernel(batchWorld, schedule, batch, *scratch, result, counts);
        };
    });
    return atlas;
}

CacheAtlas fillFromVct(const CachePlaces& places, const CacheTables& tables, const VctWorld& world, const CacheSettings& settings, int lanes)
{
    return fillByRadiance(places, tables, RadianceBatchWorld(world), world.cones, settings, lanes);
}

CacheAtlas fillFromVoxels(const CachePlaces& places, const CacheTables& tables, const VoxelWorld& world, const CacheSettings& settings, int lanes)
{
    const RadianceMarch march{.grid = world.grid, .settings = world.cones.march, .opacity = world.opacity, .preExposure = world.volume.preExposure};
    return fillByRadiance(places, tables, RadianceBatchWorld(world.volume, march), world.cones, settings, lanes);
}

}  // namespace lrsm
