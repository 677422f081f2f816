#include "conetrace/lrsm/gather.h"

#include "conetrace/frame/tile_batch.h"
#include "conetrace/frame/tiles.h"
#include "conetrace/lrsm/explain.h"
#include "conetrace/lrsm/gather_pixel.h"
#include "conetrace/lrsm/gather_rays.h"
#include "conetrace/lrsm/march_slab_batch.h"
#include "conetrace/lrsm/memory.h"
#include "voxel/sample_opacity.h"

#include <deque>
#include <memory>
#include <utility>

namespace lrsm {
namespace {

/// Of the march itself it is told nothing.
struct ResultRecorder : NoRecorder, ConeKeeper {};

/// What the tiles fill in.
struct GatherOutput {
    Gathered& gathered;
    ConeRecord* record;  ///< may be null
    ConeCounts& counts;
};

/// The pixels of one tile by Algorithm 1, one after the other.
template <class SamplerOf>
void gatherTile(const GBuffer& gbuffer, const Camera& camera, const std::vector<ConeWorld>& worlds, const SamplerOf& samplerOf, const GatherPlan& plan,
                int tileX, int tileY, const GatherOutput& to, ConeCounts& counts)
{
    Gathered& out = to.gathered;
    MarchScratch scratch;
    forPixels(gbuffer.width, gbuffer.height, tileX, tileY, [&](int x, int y) {
        const std::size_t pixel = out.irradiance.index(x, y);
        if (!gbuffer.covered(pixel)) return;
        const ConeWorld& world = worlds[std::size_t(cascadeOfPixel(gbuffer, worlds[0].opacity, worlds[0].settings, x, y))];
        const auto& sampler = samplerOf(world);
        const Receiver receiver = receiverAt(gbuffer, world.opacity.base.grid, world.settings, x, y);
        ResultRecorder recorder{{}, diffuseKeeper(to.record, pixel)};
        const PixelGather diffuse = gatherDiffuse<Estimator::paper>(world, sampler, plan, receiver, scratch, counts, recorder);
        out.irradiance.texels[pixel] = diffuse.irradiance;
        out.opacity.texels[pixel] = diffuse.opacity;
        if (out.specular.empty() || gbuffer.specularColor.texels[pixel] == Vec3(0.0f)) return;
        const Vec3 toEye = glm::normalize(directionToEye(camera, receiver.position));
        const float roughness = gbuffer.roughness.texels[pixel];
        const LobeDirection lobe = plan.lobes.direction(receiver.normal, toEye, roughness, receiver.rotation);
        recorder = {{}, specularKeeper(to.record, pixel)};
        out.specular.texels[pixel] = gatherSpecular<Estimator::paper>(world, sampler, plan, receiver, lobe.direction, roughness, scratch, counts, recorder);
        if (!out.lobeWeight.empty()) out.lobeWeight.texels[pixel] = lobe.weight;
    });
}

/// `paper`, Algorithm 1 as printed: one cone at a time.
void gatherPaper(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const GatherPlan& plan, const GatherOutput& out)
{
    const std::vector<ConeWorld> worlds = cascadeWorlds(world);
    const FilterFraction fraction = world.settings.march.filterFraction;
    const auto gatherWith = [&](const auto& samplerOf) {
        out.counts += forTiles<ConeCounts>(gbuffer.width, gbuffer.height, [&] {
            return [&](int tileX, int tileY, ConeCounts& counts) { gatherTile(gbuffer, camera, worlds, samplerOf, plan, tileX, tileY, out, counts); };
        });
    };
    if (worlds.size() > 1)
        gatherWith([&](const ConeWorld& own) { return GenericSampler{own.opacity, fraction}; });
    else
        withOpacitySampler(world.opacity, fraction, [&](const auto& sampler) { gatherWith([&](const ConeWorld&) -> const auto& { return sampler; }); });
}

/// `slab`: tile by tile at the widest that the machine has.
void gatherSlab(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const GatherPlan& plan, const GatherOutput& out, int lanes)
{
    const std::vector<ConeWorld> cascades = cascadeWorlds(world);
    std::deque<BatchWorld> worlds;  // which do not move
    for (const ConeWorld& own : cascades) {
        if (worlds.empty())
            worlds.emplace_back(own);
        else
            worlds.emplace_back(own, worlds[0].maps);
    }
    const MarchBatch kernel = marchSlabBatch(lanes);
    const float unit = unexposed(world.lrsms);
    for (std::size_t cascade = 0; cascade < worlds.size(); ++cascade) {
        const BatchWorld& own = worlds[cascade];
        const TileGather gather{gbuffer, camera, own.cones.opacity.base.grid, own.cones.settings, plan, out.gathered, out.record};
        const auto mine = [&](int x, int y) {
            return worlds.size() == 1 || cascadeOfPixel(gbuffer, worlds[0].cones.opacity, own.cones.settings, x, y) == int(cascade);
        };
        out.counts += gatherTiles(gather, mine, [&] {
            return [&, scratch = std::make_unique_for_overwrite<MarchBatchScratch>()](const MarchSchedule& schedule, const ConeBatch& cones,
                                                                                      ConeBatchResult& result, ConeCounts& counts) {
                kernel(own, schedule, cones, *scratch, result, counts);
                for (int k = 0; k < cones.count; ++k)
                    for (int c = 0; c < 3; ++c) result.radiance[k][c] *= unit;
            };
        });
    }
}

struct KeptLrsms {
    std::vector<Lrsm> lrsms;
    std::vector<MadeFrom> made;
};

std::string passName(std::size_t light)
{
    return "lrsm " + std::to_string(light);
}

}  // namespace

std::vector<Lrsm> buildLrsms(const std::vector<Rsm>& rsms, const LayerSettings& settings, PassLog& log)
{
    std::vector<Lrsm> lrsms;
    for (std::size_t i = 0; i < rsms.size(); ++i) lrsms.push_back(log.run(passName(i), kWorldPass, [&] { return buildLrsm(rsms[i], settings); }));
    return lrsms;
}

const std::vector<Lrsm>& layersOf(const GatherInput& input, PassLog& log, std::vector<Lrsm>& own)
{
    const LayerSettings& settings = input.settings.layers;
    if (!input.kept) return own = buildLrsms(input.rsms, settings, log);
    auto& [lrsms, made] = ownOf<KeptLrsms>(*input.kept);
    lrsms.resize(input.rsms.size());
    made.resize(input.rsms.size());
    for (std::size_t i = 0; i < lrsms.size(); ++i) {
        Lrsm& lrsm = lrsms[i];
        const Rsm& rsm = input.rsms[i];
        const bool kept = keepOrMake(made[i], input.kept->rsmsMade[i].key, log, [&] {
            lrsm = {};
            lrsm = log.run(passName(i), kWorldPass, [&] { return buildLrsm(rsm, settings); });
        });
        if (kept) log.show(passName(i), lrsm);
    }
    return lrsms;
}

Gathered traceCones(const GBuffer& gbuffer, const Camera& camera, const OpacityPyramid& opacity, const std::vector<Lrsm>& lrsms, const Requirements& needs,
                    const ConeSettings& settings, ConeRecord* record, int lanes)
{
    if (record) *record = ConeRecord(gbuffer, needs, settings);
    const GatherPlan plan = planGather(settings, needs, outermostEdge(opacity));
    Gathered out = emptyGathered(gbuffer, needs, plan.lobes.sampling());
    const NormalCdf phi(settings.gather.gaussian, settings.gather.gaussianTableSize);
    const ConeWorld world{.opacity = opacity, .lrsms = lrsms, .settings = settings, .phi = phi};
    ConeCounts counts;
    if (settings.march.estimator == Estimator::slab)
        gatherSlab(gbuffer, camera, world, plan, {out, record, counts}, lanes);
    else
        gatherPaper(gbuffer, camera, world, plan, {out, record, counts});
    out.counters = countersOf(counts);
    return out;
}

Gathered gatherLrsm(const GatherInput& input, PassLog& log)
{
    std::vector<Lrsm> own;
    const std::vector<Lrsm>& lrsms = layersOf(input, log, own);
    const ConeSettings& settings = input.settings.cones;
    ConeRecord kept;
    ConeRecord* const record = log.observed() ? &kept : nullptr;
    Gathered gathered;
    switch (settings.march.visibility) {
    case Visibility::cones:
        gathered = log.run("cones", kPicturePass,
                           [&] { return traceCones(input.gbuffer, input.camera, input.opacity, lrsms, input.needs, settings, record, input.lanes); });
        break;
    case Visibility::rays: {
        const EmbreeScene scene = log.run("bvh", kWorldPass, [&] { return EmbreeScene(input.scene, RayKinds::bounces); });
        gathered = log.run("rays", kPicturePass, [&] { return traceRays(input.gbuffer, input.camera, scene, lrsms, input.needs, settings, record); });
        break;
    }
    case Visibility::voxelRays:
        gathered =
            log.run("rays", kPicturePass, [&] { return traceVoxelRays(input.gbuffer, input.camera, input.opacity, lrsms, input.needs, settings, record); });
        break;
    }
    log.show("cones", kept);
    gathered.filter4x4 = settings.set.filter;
    return gathered;
}

GatherMethod lrsmMethod(Visibility visibility)
{
    GatherMethod method{.reads = {.bits = true, .mips = true}, .gather = gatherLrsm, .explain = explainLrsm, .predict = predictLrsms};
    if (visibility == Visibility::cones) return method;
    method.explain = {};
    if (visibility == Visibility::rays) method.reads = {};
    return method;
}

}  // namespace lrsm
