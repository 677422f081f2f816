#include "conetrace/vct/gather.h"

#include "conetrace/frame/pixel_cones.h"
#include "conetrace/frame/tiles.h"
#include "conetrace/vct/explain.h"
#include "conetrace/vct/inject.h"
#include "conetrace/vct/march.h"
#include "conetrace/vct/memory.h"

#include <optional>

namespace lrsm {
namespace {

struct Silent {};

/// Keeps whole cones' results where they are asked for.
struct ResultRecorder {
    Vec4* next = nullptr;  ///< none: nothing is kept
    std::size_t stride = 0;
    void result(const ConeResult& cone)
    {
        if (!next) return;
        *next = Vec4(cone.radiance, cone.opacity);
        next += stride;
    }
};

/// What the tiles fill in.
struct GatherOutput {
    Gathered& gathered;
    ConeRecord* record;  ///< may be null
    ResultRecorder diffuseAt(std::size_t pixel) const
    {
        return record ? ResultRecorder{record->diffuse.data() + pixel, gathered.irradiance.texels.size()} : ResultRecorder{};
    }
    ResultRecorder specularAt(std::size_t pixel) const { return record ? ResultRecorder{record->specular.texels.data() + pixel, 0} : ResultRecorder{}; }
};

/// The pixels of one tile.
void gatherRadianceTile(const GatherInput& input, const VctWorld& world, const GatherPlan& plan, int tileX, int tileY, const GatherOutput& to,
                        ConeCounts& counts)
{
    const GBuffer& gbuffer = input.gbuffer;
    Gathered& out = to.gathered;
    Silent silent;
    const auto march = [&](const ConeRay& ray, const MarchSchedule& schedule) { return marchRadiance(world, ray, schedule, counts, silent); };
    forPixels(gbuffer.width, gbuffer.height, tileX, tileY, [&](int x, int y) {
        const std::size_t pixel = gbuffer.position.index(x, y);
        if (!gbuffer.covered(pixel)) return;
        const Receiver receiver = receiverAt(gbuffer, world.grid, world.cones, x, y);
        ResultRecorder recorder = to.diffuseAt(pixel);
        const PixelGather diffuse = gatherDiffuse(plan, world.cones.set.setsPerPixel, receiver, march, recorder);
        out.irradiance.texels[pixel] = diffuse.irradiance;
        out.opacity.texels[pixel] = diffuse.opacity;
        if (out.specular.empty() || gbuffer.specularColor.texels[pixel] == Vec3(0.0f)) return;
        const Vec3 toEye = glm::normalize(directionToEye(input.camera, receiver.position));
        recorder = to.specularAt(pixel);
        out.specular.texels[pixel] = gatherSpecular(plan, receiver, toEye, gbuffer.roughness.texels[pixel], march, recorder);
    });
}

}  // namespace

RadianceVolume buildRadiance(const GatherInput& input, PassLog& log)
{
    const Settings& settings = input.settings;
    std::optional<VoxelSurface> surface;
    if (readsSurface(settings.vct)) {
        surface =
            log.run("vct surface", kPassedOn, [&] { return voxelSurface(input.scene, input.opacity.base, settings.voxel, settings.surface.textureFilter); });
        log.show("vct surface", PlacedSurface{input.opacity.base, *surface});
    }
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
    Gathered out = emptyGathered(gbuffer, input.needs);
    if (record) *record = ConeRecord(gbuffer, input.needs, cones);
    const GatherPlan plan = planVct(cones, input.needs, volume.resolution());
    const VctWorld world{.volume = volume, .grid = input.opacity.base.grid, .cones = cones, .vct = input.settings.vct};
    const ConeCounts counts = forTiles<ConeCounts>(gbuffer.width, gbuffer.height, [&] {
        return [&](int tileX, int tileY, ConeCounts& tile) { gatherRadianceTile(input, world, plan, tileX, tileY, {out, record}, tile); };
    });
    out.counters = countersOf(counts);
    return out;
}

Gathered gatherVct(const GatherInput& input, PassLog& log)
{
    const RadianceVolume volume = buildRadiance(input, log);
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
