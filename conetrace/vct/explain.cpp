#include "conetrace/vct/explain.h"

#include "conetrace/frame/pixel_cones.h"
#include "conetrace/vct/gather.h"
#include "conetrace/vct/march.h"

#include <cstdio>

namespace lrsm {
namespace {

template <class... Values>
std::string line(const char* pattern, Values... values)
{
    char text[512];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

/// Writes down everything that the march tells.
struct VctText {
    std::string text;
    int cones = 0, steps = 0;

    void cone(const ConeRay& ray, float weight, float tanHalf)
    {
        const Vec3& d = ray.direction;
        text += line("\ncone %d  direction %.4f %.4f %.4f  weight %.5f  tan half-angle %.4f\n", cones++, double(d.x), double(d.y), double(d.z), double(weight),
                     double(tanHalf));
        text += "  step  distance  diameter  level  opacity  radiance (premultiplied)         spent     transmittance  position\n";
        steps = 0;
    }
    void step(const VctStep& r)
    {
        text += line("  %4d  %8.3f  %8.3f  %5.2f  %7.4f  %9.4g %9.4g %9.4g  %8.5f  %8.5f       %.4f %.4f %.4f\n", steps++, double(r.step->middle),
                     double(r.step->diameter), double(r.step->level), double(r.sample.w), double(r.sample.x), double(r.sample.y), double(r.sample.z),
                     double(r.spent), double(r.transmittance), double(r.pWorld.x), double(r.pWorld.y), double(r.pWorld.z));
    }
    void result(const ConeResult& r)
    {
        text += line("  I = %.6g %.6g %.6g   opacity %.5f\n", double(r.radiance.x), double(r.radiance.y), double(r.radiance.z), double(r.opacity));
    }
};

}  // namespace

std::string explainVct(const GatherInput& input, int x, int y)
{
    const GBuffer& gbuffer = input.gbuffer;
    const std::size_t pixel = gbuffer.position.index(x, y);
    if (!gbuffer.covered(pixel)) return line("pixel %d,%d: nothing is drawn here\n", x, y);
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
        const Vec3 radiance = gatherSpecular(plan, receiver, toEye, gbuffer.roughness.texels[pixel], march, recorder);
        specular = line("specular cone (the last above): I = %.6g %.6g %.6g\n", double(radiance.x), double(radiance.y), double(radiance.z));
    }
    const Vec3 p = receiver.position, n = receiver.normal, albedo = gbuffer.albedo.texels[pixel];
    std::string text = line("pixel %d,%d: object %u at %.5f %.5f %.5f, normal %.4f %.4f %.4f, albedo %.4f %.4f %.4f, rotation %d of %d\n", x, y,
                            gbuffer.objectId.texels[pixel], double(p.x), double(p.y), double(p.z), double(n.x), double(n.y), double(n.z), double(albedo.x),
                            double(albedo.y), double(albedo.z), receiver.rotation, kRotations);
    text += line("distances and diameters in voxels of %.6g m; spent is what a step takes of the transmittance\n", double(world.grid.voxelSize));
    if (volume.preExposure != 1.0f) text += line("radiance of samples is times %g, the light maps' pre-exposure\n", double(volume.preExposure));
    text += recorder.text;
    text += line("\nirradiance (before the 4x4 filter) %.6g %.6g %.6g, opacity %.5f\n", double(diffuse.irradiance.x), double(diffuse.irradiance.y),
                 double(diffuse.irradiance.z), double(diffuse.opacity));
    text += specular + line("%llu cones, %llu samples\n", static_cast<unsigned long long>(counts.cones), static_cast<unsigned long long>(counts.steps));
    const glm::dvec3& origin = input.scene.origin;
    if (origin != glm::dvec3(0.0)) text += line("positions count from %.10g %.10g %.10g, the scene's origin\n", origin.x, origin.y, origin.z);
    return text;
}

}  // namespace lrsm
