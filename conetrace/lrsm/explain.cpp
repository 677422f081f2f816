#include "conetrace/lrsm/explain.h"

#include "conetrace/frame/pixel_text.h"
#include "conetrace/lrsm/gather.h"
#include "conetrace/lrsm/gather_pixel.h"

#include <string>

namespace lrsm {
namespace {

/// Writes down everything that the march tells.
struct TextRecorder {
    static constexpr bool active = true;
    std::string text;
    int cones = 0;

    void cone(const ConeRay& ray, float weight, float tanHalf)
    {
        text += coneText(cones++, ray.direction, weight, tanHalf);
        text += "  step  distance  diameter  level   density     alpha       transmittance  position\n";
        steps = 0;
    }
    void step(const StepRecord& r)
    {
        text += formatted("  %4d  %8.3f  %8.3f  %5.2f  %10.3e  %10.3e  %10.6f     %.4f %.4f %.4f\n", steps++, double(r.step->middle), double(r.step->diameter),
                          double(r.step->level), double(r.density), double(r.alpha), double(r.transmittance), double(r.pWorld.x), double(r.pWorld.y),
                          double(r.pWorld.z));
    }
    void layer(int light, const LayerTerms& t, float transmittance)
    {
        text += formatted(
            "        light %d layer %d  R %.4g %.4g %.4g  A %.4f  N %.4f  mean %.4f  variance %.3e  V %.5f  f %.4f  T %.5f"
            "  -> %.4g %.4g %.4g\n",
            light, t.layer, double(t.radiance.x), double(t.radiance.y), double(t.radiance.z), double(t.alpha), double(t.normal), double(t.mean),
            double(t.variance), double(t.visibility), double(t.decay), double(transmittance), double(t.outgoing.x), double(t.outgoing.y), double(t.outgoing.z));
    }
    void result(const ConeResult& r) { text += resultText(r.radiance, r.opacity); }

  private:
    int steps = 0;
};

template <Estimator estimator>
std::string explainWith(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const GatherPlan& plan, int x, int y)
{
    const std::size_t pixel = gbuffer.position.index(x, y);
    const GenericSampler sampler{world.opacity, world.settings.march.filterFraction};
    const Receiver receiver = receiverAt(gbuffer, world.opacity.base.grid, world.settings, x, y);
    MarchScratch scratch;
    ConeCounts counts;
    TextRecorder recorder;

    const PixelGather diffuse = gatherDiffuse<estimator>(world, sampler, plan, receiver, scratch, counts, recorder);
    std::string specular;
    if (!plan.specularSchedules.empty() && gbuffer.specularColor.texels[pixel] != Vec3(0.0f)) {
        const Vec3 toEye = glm::normalize(directionToEye(camera, receiver.position));
        const float roughness = gbuffer.roughness.texels[pixel];
        const LobeDirection lobe = plan.lobes.direction(receiver.normal, toEye, roughness, receiver.rotation);
        const Vec3 radiance = gatherSpecular<estimator>(world, sampler, plan, receiver, lobe.direction, roughness, scratch, counts, recorder);
        specular = specularText(radiance);
    }

    return receiverText(gbuffer, receiver, x, y) +
           formatted("distances and diameters in voxels of %.6g m; N is the crossing rate g and V the segment's share w in the slab estimator\n",
                     double(world.opacity.base.grid.voxelSize)) +
           recorder.text + irradianceText(diffuse.irradiance, diffuse.opacity) + specular +
           formatted("%llu cones, %llu steps, %llu voxel taps, %llu layer samples\n", static_cast<unsigned long long>(counts.cones),
                     static_cast<unsigned long long>(counts.steps), static_cast<unsigned long long>(counts.voxelTaps),
                     static_cast<unsigned long long>(counts.lrsmSamples));
}

}  // namespace

std::string explainLrsm(const GatherInput& input, int x, int y)
{
    if (!input.gbuffer.covered(input.gbuffer.position.index(x, y))) return nothingDrawnText(x, y);
    const ConeSettings& settings = input.settings.cones;
    std::vector<Lrsm> lrsms;
    for (const Rsm& rsm : input.rsms) lrsms.push_back(buildLrsm(rsm, input.settings.layers));
    const GatherPlan plan = planGather(settings, input.needs, outermostEdge(input.opacity));
    const NormalCdf phi(settings.gather.gaussian, settings.gather.gaussianTableSize);
    const ConeWorld finest{.opacity = input.opacity, .lrsms = lrsms, .settings = settings, .phi = phi};
    const int cascade = cascadeOfPixel(input.gbuffer, input.opacity, settings, x, y);
    const std::vector<ConeWorld> worlds = cascadeWorlds(finest);
    const ConeWorld& world = worlds[std::size_t(cascade)];
    std::string text = settings.march.estimator == Estimator::slab ? explainWith<Estimator::slab>(input.gbuffer, input.camera, world, plan, x, y)
                                                                   : explainWith<Estimator::paper>(input.gbuffer, input.camera, world, plan, x, y);
    if (worlds.size() > 1) text += formatted("cones count in voxels of cascade %d of %d, 0 the finest\n", cascade, int(worlds.size()));
    text += originText(input.scene);
    if (!lrsms.empty() && lrsms[0].preExposure != 1.0f)
        text += formatted("R of layers, and what they give (->), are times %g, the light maps' pre-exposure\n", double(lrsms[0].preExposure));
    return text;
}

}  // namespace lrsm
