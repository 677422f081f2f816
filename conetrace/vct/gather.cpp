#include "conetrace/vct/gather.h"

#include "conetrace/frame/tile_batch.h"
#include "conetrace/vct/explain.h"
#include "conetrace/vct/inject.h"
#include "conetrace/vct/march_radiance_batch.h"
#include "conetrace/vct/memory.h"
#include "core/base/hash.h"

#include <memory>
#include <optional>

namespace lrsm {
namespace {

struct KeptRadiance {
    RadianceVolume volume;
    MadeFrom made;
};

}  // namespace

const RadianceVolume& radianceOf(const GatherInput& input, PassLog& log, RadianceVolume& own)
{
    if (!input.kept || log.observed()) return own = buildRadiance(input, log);
    KeptRadiance& kept = ownOf<KeptRadiance>(*input.kept);
    Sha256 key;
    key.add(input.kept->geometry);
    for (const MadeFrom& rsm : input.kept->rsmsMade) key.add(rsm.key);
    keepOrMake(kept.made, key.hex(), log, [&] {
        kept.volume = {};
        kept.volume = buildRadiance(input, log);
    });
    return kept.volume;
}

VoxelSurface buildSurface(const GatherInput& input, PassLog& log)
{
    const Settings& settings = input.settings;
    VoxelSurface surface =
        log.run("vct surface", kPassedOn, [&] { return voxelSurface(input.scene, input.opacity.base, settings.voxel, settings.surface.textureFilter); });
    log.show("vct surface", PlacedSurface{input.opacity.base, surface});
    return surface;
}

RadianceVolume buildRadiance(const GatherInput& input, PassLog& log)
{
    const Settings& settings = input.settings;
    std::optional<VoxelSurface> surface;
    if (readsSurface(settings.vct)) surface = buildSurface(input, log);
    RadianceVolume volume = log.run("vct inject", kPassedOn, [&] { return injectRadiance(input, surface ? &*surface : nullptr); });
    surface.reset();
    return log.run("vct mips", kWorldPass, [&] {
        buildRadianceMips(volume, settings.vct);
        return std::move(volume);
    });
}

GatherPlan planVct(const ConeSettings& settings, const Requirements& needs, int gridResolution)
{
    ConeSettings own = settings;
    own.march.estimator = Estimator::paper;
    return planGather(own, needs, gridResolution);
}

Gathered traceRadiance(const GatherInput& input, const RadianceVolume& volume, ConeRecord* record)
{
    const ConeSettings& cones = input.settings.cones;
    const GBuffer& gbuffer = input.gbuffer;
    if (record) *record = ConeRecord(gbuffer, input.needs, cones);
    const GatherPlan plan = planVct(cones, input.needs, volume.resolution());
    Gathered out = emptyGathered(gbuffer, input.needs, plan.lobes.sampling());
    const RadianceBatchWorld world(VctWorld{.volume = volume, .grid = input.opacity.base.grid, .cones = cones, .vct = input.settings.vct});
    const RadianceMarchBatch kernel = marchRadianceBatch(input.lanes);
    const TileGather gather{gbuffer, input.camera, input.opacity.base.grid, cones, plan, out, record};
    const auto all = [](int, int) { return true; };
    out.counters = countersOf(gatherTiles(gather, all, [&] {
        return [&, scratch = std::make_unique_for_overwrite<RadianceBatchScratch>()](const MarchSchedule& schedule, const ConeBatch& batch,
                                                                                     ConeBatchResult& result, ConeCounts& counts) {
            kernel(world, schedule, batch, *scratch, result, counts);
        };
    }));
    return out;
}

Gathered gatherVct(const GatherInput& input, PassLog& log)
{
    RadianceVolume own;
    const RadianceVolume& volume = radianceOf(input, log, own);
    ConeRecord kept;
    ConeRecord* const record = log.observed() ? &kept : nullptr;
    Gathered gathered = log.run("vct cones", kPicturePass, [&] { return traceRadiance(input, volume, record); });
    log.show("vct cones", kept);
    gathered.filter4x4 = input.settings.cones.set.filter;
    return gathered;
}

GatherMethod vctMethod()
{
    return {.reads = {.bits = true, .mips = false}, .gather = gatherVct, .explain = explainVct, .predict = predictRadiance};
}

}  // namespace lrsm
