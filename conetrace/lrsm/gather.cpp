#include "conetrace/lrsm/gather.h"

#include "conetrace/lrsm/explain.h"
#include "conetrace/lrsm/gather_pixel.h"
#include "conetrace/lrsm/memory.h"
#include "core/base/parallel.h"
#include "voxel/sample_opacity.h"

namespace lrsm {
namespace {

constexpr int kTile = 16;

/// Keeps whole cones' results where they are asked for; of the march itself it is told nothing.
struct ResultRecorder : NoRecorder {
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
    ConeCounts& counts;
    ResultRecorder diffuseAt(std::size_t pixel) const
    {
        ResultRecorder recorder;
        if (record) recorder.next = record->diffuse.data() + pixel;
        recorder.stride = gathered.irradiance.texels.size();
        return recorder;
    }
    ResultRecorder specularAt(std::size_t pixel) const
    {
        ResultRecorder recorder;
        if (record) recorder.next = record->specular.texels.data() + pixel;
        return recorder;
    }
};

/// Traces the pixels of one tile.
template <Estimator estimator, class Sampler>
void gatherTile(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const Sampler& sampler, const GatherPlan& plan, int tileX, int tileY,
                const GatherOutput& to, ConeCounts& counts)
{
    Gathered& out = to.gathered;
    MarchScratch scratch;
    scratch.opticalDepth.resize(plan.longestSchedule);
    const int xEnd = std::min(gbuffer.width, (tileX + 1) * kTile), yEnd = std::min(gbuffer.height, (tileY + 1) * kTile);
    for (int y = tileY * kTile; y < yEnd; ++y) {
        for (int x = tileX * kTile; x < xEnd; ++x) {
            const std::size_t pixel = out.irradiance.index(x, y);
            if (!gbuffer.covered(pixel)) continue;
            const Receiver receiver = receiverAt(gbuffer, world.opacity.base.grid, world.settings, x, y);
            ResultRecorder recorder = to.diffuseAt(pixel);
            const PixelGather diffuse = gatherDiffuse<estimator>(world, sampler, plan, receiver, scratch, counts, recorder);
            out.irradiance.texels[pixel] = diffuse.irradiance;
            out.opacity.texels[pixel] = diffuse.opacity;
            if (out.specular.empty() || gbuffer.specularColor.texels[pixel] == Vec3(0.0f)) continue;
            const Vec3 toEye = glm::normalize(directionToEye(camera, receiver.position));
            recorder = to.specularAt(pixel);
            out.specular.texels[pixel] =
                gatherSpecular<estimator>(world, sampler, plan, receiver, toEye, gbuffer.roughness.texels[pixel], scratch, counts, recorder);
        }
    }
}

template <Estimator estimator, class Sampler>
void gatherAll(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const Sampler& sampler, const GatherPlan& plan, const GatherOutput& out)
{
    const int tilesX = (gbuffer.width + kTile - 1) / kTile, tilesY = (gbuffer.height + kTile - 1) / kTile;
    std::vector<ConeCounts> counts(std::size_t(tilesX) * std::size_t(tilesY));
    parallelFor(counts.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t tile = begin; tile < end; ++tile)
            gatherTile<estimator>(gbuffer, camera, world, sampler, plan, static_cast<int>(tile) % tilesX, static_cast<int>(tile) / tilesX, out, counts[tile]);
    });
    for (const ConeCounts& tile : counts) out.counts += tile;
}

/// Picks the lookup: specialised for what presets use, generic otherwise; the bits are the same.
template <Estimator estimator>
void gatherWith(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const GatherPlan& plan, const GatherOutput& out)
{
    const OpacityPyramid& opacity = world.opacity;
    if (opacity.storage != Storage::gpu || world.settings.march.filterFraction != FilterFraction::exact) {
        gatherAll<estimator>(gbuffer, camera, world, GenericSampler{opacity, world.settings.march.filterFraction}, plan, out);
    } else if (opacity.axes == OpacityAxes::directional) {
        const OpacitySampler<Storage::gpu, OpacityAxes::directional, FilterFraction::exact> sampler(opacity);
        gatherAll<estimator>(gbuffer, camera, world, sampler, plan, out);
    } else {
        const OpacitySampler<Storage::gpu, OpacityAxes::isotropic, FilterFraction::exact> sampler(opacity);
        gatherAll<estimator>(gbuffer, camera, world, sampler, plan, out);
    }
}

}  // namespace

std::vector<Lrsm> buildLrsms(const std::vector<Rsm>& rsms, const LayerSettings& settings, PassLog& log)
{
    std::vector<Lrsm> lrsms;
    for (const Rsm& rsm : rsms) lrsms.push_back(log.run("lrsm " + std::to_string(lrsms.size()), kWorldPass, [&] { return buildLrsm(rsm, settings); }));
    return lrsms;
}

Gathered traceCones(const GBuffer& gbuffer, const Camera& camera, const OpacityPyramid& opacity, const std::vector<Lrsm>& lrsms, const Requirements& needs,
                    const ConeSettings& settings, ConeRecord* record)
{
    Gathered out;
    out.irradiance = Image<Vec3>(gbuffer.width, gbuffer.height);
    out.opacity = Image<float>(gbuffer.width, gbuffer.height);
    if (needs.specular) out.specular = Image<Vec3>(gbuffer.width, gbuffer.height);

    if (record) {
        record->cones = settings.set.count * settings.set.setsPerPixel;
        record->diffuse.assign(static_cast<std::size_t>(record->cones) * out.irradiance.texels.size(), Vec4(0.0f));
        record->specular = needs.specular ? Image<Vec4>(gbuffer.width, gbuffer.height, Vec4(0.0f)) : Image<Vec4>();
    }

    const GatherPlan plan = planGather(settings, needs, opacity.base.grid.resolution);
    const NormalCdf phi(settings.gather.gaussian, settings.gather.gaussianTableSize);
    const ConeWorld world{.opacity = opacity, .lrsms = lrsms, .settings = settings, .phi = phi};
    ConeCounts counts;
    if (settings.march.estimator == Estimator::slab)
        gatherWith<Estimator::slab>(gbuffer, camera, world, plan, {out, record, counts});
    else
        gatherWith<Estimator::paper>(gbuffer, camera, world, plan, {out, record, counts});
    out.counters = countersOf(counts);
    return out;
}

Gathered gatherLrsm(const GatherInput& input, PassLog& log)
{
    const std::vector<Lrsm> lrsms = buildLrsms(input.rsms, input.settings.layers, log);
    ConeRecord record;
    Gathered gathered = log.run("cones", kPicturePass, [&] {
        return traceCones(input.gbuffer, input.camera, input.opacity, lrsms, input.needs, input.settings.cones, log.observed() ? &record : nullptr);
    });
    log.show("cones", record);
    gathered.filter4x4 = input.settings.cones.set.filter;
    return gathered;
}

GatherMethod lrsmMethod()
{
    return {.reads = {.bits = true, .mips = true}, .gather = gatherLrsm, .explain = explainLrsm, .predict = predictLrsms};
}

}  // namespace lrsm
