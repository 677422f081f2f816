#include "conetrace/caches/fill.h"

#include "conetrace/lrsm/march_slab_batch.h"
#include "core/base/elementary.h"
#include "core/base/parallel.h"

#include <memory>

namespace lrsm {
namespace {

constexpr std::size_t kBatchesPerTask = 8, kFilledPerTask = 4;

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

void addCounts(CacheAtlas& atlas, const std::vector<FillCounts>& partial)
{
    for (const FillCounts& counts : partial) {
        atlas.cones += counts.cones;
        atlas.conversions += counts.conversions;
    }
}

/// A cone at a time: march(ConeRay, counts) is its ConeResult.
template <class March>
CacheAtlas fillOneByOne(const CachePlaces& places, const CacheTables& tables, const VoxelGrid& grid, const MarchSettings& settings, float preExposure,
                        const CacheSettings& caches, const March& march)
{
    CacheAtlas atlas = emptyAtlas(places, tables, preExposure, caches);
    std::vector<FillCounts> partial(places.size() / kFilledPerTask + 1);
    parallelFor(places.size(), kFilledPerTask, [&](std::size_t begin, std::size_t end) {
        FillCounts& counts = partial[begin / kFilledPerTask];
        for (std::size_t cache = begin; cache < end; ++cache)
            for (std::size_t texel = 0; texel < tables.texels(); ++texel) {
                const ConeResult cone = march(texelCone(places, tables, grid, settings, cache, texel), counts.cones);
                atlas.levels[0][cache * tables.texels() + texel] = storedTexel(Vec4(cone.radiance * preExposure, cone.opacity), caches, counts.conversions);
            }
    });
    addCounts(atlas, partial);
    return atlas;
}

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
        const ConeRay ray = texelCone(places_, tables_, world_.cones.opacity.base.grid, world_.cones.settings.march, cache, texel);
        cones_->setOrigin(cone, ray.originVoxels, ray.originWorld);
        cones_->setDirection(cone, ray.direction);
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
    std::vector<Vec4>& texels = atlas.levels[0];
    const std::size_t batches = (texels.size() + kBatchCones - 1) / kBatchCones;
    std::vector<FillCounts> partial(batches / kBatchesPerTask + 1);
    parallelFor(batches, kBatchesPerTask, [&](std::size_t begin, std::size_t end) {
        CacheBatch batch(places, tables, batchWorld);
        FillCounts& counts = partial[begin / kBatchesPerTask];
        for (std::size_t b = begin; b < end; ++b) {
            const std::size_t first = b * kBatchCones, last = std::min(texels.size(), first + kBatchCones);
            batch.march(kernel, schedule, first, last, counts.cones);
            for (std::size_t i = first; i < last; ++i) texels[i] = storedTexel(batch.texel(i - first), settings, counts.conversions);
        }
    });
    addCounts(atlas, partial);
    return atlas;
}

CacheAtlas fillFromVct(const CachePlaces& places, const CacheTables& tables, const VctWorld& world, const CacheSettings& settings)
{
    const MarchSchedule schedule = texelSchedule(settings, world.cones, world.grid.resolution);
    return fillOneByOne(places, tables, world.grid, world.cones.march, world.volume.preExposure, settings, [&](const ConeRay& ray, ConeCounts& counts) {
        NoRecorder nobody;
        return marchRadiance(world, ray, schedule, counts, nobody);
    });
}

CacheAtlas fillFromVoxels(const CachePlaces& places, const CacheTables& tables, const VoxelWorld& world, const CacheSettings& settings)
{
    const MarchSchedule schedule = texelSchedule(settings, world.cones, world.grid.resolution);
    const RadianceMarch march{.grid = world.grid, .settings = world.cones.march, .opacity = world.opacity, .preExposure = world.volume.preExposure};
    const IsotropicLookup lookUp(world.volume, world.cones.march.filterFraction);
    return fillOneByOne(places, tables, world.grid, world.cones.march, world.volume.preExposure, settings, [&](const ConeRay& ray, ConeCounts& counts) {
        NoRecorder nobody;
        return marchRadiance(march, lookUp, ray, schedule, counts, nobody);
    });
}

}  // namespace lrsm
