#include "conetrace/vct/explain.h"

#include "conetrace/frame/pixel_cones.h"
#include "conetrace/frame/pixel_text.h"
#include "conetrace/vct/gather.h"
#include "conetrace/vct/march.h"

namespace lrsm {
namespace {

/// Writes down everything that the march tells.
struct VctText {
    std::string text;
    int cones = 0, steps = 0;

    void cone(const ConeRay& ray, float weight, float tanHalf)
    {
        text += coneText(cones++, ray.direction, weight, tanHalf);
        text += "  step  distance  diameter  level  opacity  radiance (premultiplied)         spent     transmittance  position\n";
        steps = 0;
    }
    void step(const VctStep& r)
    {
        text += formatted("  %4d  %8.3f  %8.3f  %5.2f  %7.4f  %9.4g %9.4g %9.4g  %8.5f  %8.5f       %.4f %.4f %.4f\n", steps++, double(r.step->middle),
                          double(r.step->diameter), double(r.step->level), double(r.sample.w), double(r.sample.x), double(r.sample.y), double(r.sample.z),
                          double(r.spent), double(r.transmittance), double(r.pWorld.x), double(r.pWorld.y), double(r.pWorld.z));
    }
    void result(const ConeResult& r) { text += resultText(r.radiance, r.opacity); }
};

}  // namespace

std::string explainVct(const GatherInput& input, int x, int y)
{
    const GBuffer& gbuffer = input.gbuffer;
    const std::size_t pixel = gbuffer.position.index(x, y);
    if (!gbuffer.covered(pixel)) return nothingDrawnText(x, y);
    const ConeSettings& cones = input.settings.cones;
    const PassWatch nobody{.hashPasses = false, .progress = {}, .observe = {}};
    PassLog log(nobody);
    const RadianceVolume volume = buildRadiance(input, log);
    const GatherPlan plan = planVct(cones, input.needs, volume.resolution());
    const VctWorld world{.volume = volume, .grid = input.opacity.base.grid, .cones = cones, .vct = input.settings.vct};
    const Receiver receiver = receiverAt(gbuffer, world.grid, cones, x, y);
    ConeCounts counts;
    VctText recorder;
    const auto march = [&](const ConeRay& ray, const MarchSchedule& schedule) { return marchRadiance(world, ray, schedule, counts, recorder); };

    const PixelGather diffuse = gatherDiffuse(plan, cones.set.setsPerPixel, receiver, march, recorder);
    std::string specular;
    if (input.needs.specular && gbuffer.specularColor.texels[pixel] != Vec3(0.0f)) {
        const Vec3 toEye = glm::normalize(directionToEye(input.camera, receiver.position));
        const float roughness = gbuffer.roughness.texels[pixel];
        const LobeDirection lobe = plan.lobes.direction(receiver.normal, toEye, roughness, receiver.rotation);
        const Vec3 radiance = gatherSpecular(plan, receiver, lobe.direction, roughness, march, recorder);
        specular = specularText(radiance);
    }
    std::string text = receiverText(gbuffer, receiver, x, y);
    text += formatted("distances and diameters in voxels of %.6g m; spent is what a step takes of the transmittance\n", double(world.grid.voxelSize));
    if (volume.preExposure != 1.0f) text += formatted("radiance of samples is times %g, the light maps' pre-exposure\n", double(volume.preExposure));
    text += recorder.text;
    text += irradianceText(diffuse.irradiance, diffuse.opacity);
    text += specular + formatted("%llu cones, %llu samples\n", static_cast<unsigned long long>(counts.cones), static_cast<unsigned long long>(counts.steps));
    return text + originText(input.scene);
}

}  // namespace lrsm
