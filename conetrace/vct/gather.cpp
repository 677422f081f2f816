#include "conetrace/vct/gather.h"

#include "conetrace/frame/pixel_cones.h"
#include "conetrace/frame/tiles.h"
#include "conetrace/vct/explain.h"
#include "conetrace/vct/inject.h"
#include "conetrace/vct/march.h"
#include "conetrace/vct/memory.h"
#include "core/base/hash.h"

#include <optional>

namespace lrsm {
namespace {

struct Silent {};

/// The pixels of one tile.
void gatherRadianceTile(const GatherInput& input, const VctWorld& world, const GatherPlan& plan, int tileX, int tileY, Gathered& out, ConeRecord* record,
                        ConeCounts& counts)
{
    const GBuffer& gbuffer = input.gbuffer;
    Silent silent;
    const auto march = [&](const ConeRay& ray, const MarchSchedule& schedule) { return marchRadiance(world, ray, schedule, counts, silent); };
    forPixels(gbuffer.width, gbuffer.height, tileX, tileY, [&](int x, int y) {
        const std::size_t pixel = gbuffer.position.index(x, y);
        if (!gbuffer.covered(pixel)) return;
        const Receiver receiver = receiverAt(gbuffer, world.grid, world.cones, x, y);
        ConeKeeper keeper = diffuseKeeper(record, pixel);
        const PixelGather diffuse = gatherDiffuse(plan, world.cones.set.setsPerPixel, receiver, march, keeper);
        out.irradiance.texels[pixel] = diffuse.irradiance;
        out.opacity.texels[pixel] = diffuse.opacity;
        if (out.specular.empty() || gbuffer.specularColor.texels[pixel] == Vec3(0.0f)) return;
        const Vec3 toEye = glm::normalize(directionToEye(input.camera, receiver.position));
        const float roughness = gbuffer.roughness.texels[pixel];
        const LobeDirection lobe = plan.lobes.direction(receiver.normal, toEye, roughness, receiver.rotation);
        keeper = specularKeeper(record, pixel);
        out.specular.texels[pixel] = gatherSpecular(plan, receiver, lobe.direction, roughness, march, keeper);
        if (!out.lobeWeight.empty()) out.lobeWeight.texels[pixel] = lobe.weight;
    });
}

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
    const VctWorld world{.volume = volume, .grid = input.opacity.base.grid, .cones = cones, .vct = input.settings.vct};
    const ConeCounts counts = forTiles<ConeCounts>(gbuffer.width, gbuffer.height, [&] {
        return [&](int tileX, int tileY, ConeCounts& tile) { gatherRadianceTile(input, world, plan, tileX, tileY, out, record, tile); };
    });
    out.counters = countersOf(counts);
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
