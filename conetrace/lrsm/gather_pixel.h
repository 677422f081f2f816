#pragma once

#include "conetrace/frame/gather_plan.h"
#include "conetrace/frame/receiver.h"
#include "conetrace/lrsm/march_paper.h"
#include "conetrace/lrsm/march_slab.h"

/// How one pixel is gathered; shared by the picture and by --pixel, which only record differently.
namespace lrsm {

struct PixelGather {
    Vec3 irradiance{0.0f};
    float opacity = 0.0f;
};

/// The estimator seam: all else is common. A third estimator is one more case.
template <Estimator estimator, class Sampler, class Recorder>
ConeResult marchCone(const ConeWorld& world, const Sampler& sampler, const ConeRay& ray, const MarchSchedule& schedule, MarchScratch& scratch,
                     ConeCounts& counts, Recorder& recorder)
{
    ConeResult cone;
    if constexpr (estimator == Estimator::slab)
        cone = marchSlab(world, sampler, ray, schedule, scratch, counts, recorder);
    else
        cone = marchPaper(world, sampler, ray, schedule, scratch, counts, recorder);
    cone.radiance *= unexposed(world);
    return cone;
}

inline ConeRay coneRay(const Receiver& receiver, const Vec3& direction)
{
    return {.originWorld = receiver.originWorld, .originVoxels = receiver.originVoxels, .direction = direction, .receiverNormal = receiver.geometricNormal};
}

/// A recorder is told what it has functions for: cone() before a cone, result() after it; with `active` also its steps and layers.

/// Diffuse cones of one pixel: E = pi * sum w_c I_c, averaged over setsPerPixel rotations.
template <Estimator estimator, class Sampler, class Recorder>
PixelGather gatherDiffuse(const ConeWorld& world, const Sampler& sampler, const GatherPlan& plan, const Receiver& receiver, MarchScratch& scratch,
                          ConeCounts& counts, Recorder& recorder)
{
    const Mat3 basis = basisFromNormal(receiver.normal);
    const int sets = world.settings.set.setsPerPixel;
    PixelGather sum;
    for (int s = 0; s < sets; ++s) {
        const auto directions = plan.cones.rotation((receiver.rotation + s * kRotations / sets) % kRotations);
        for (std::size_t r = 0; r < plan.cones.rings.size(); ++r) {
            const ConeRing& ring = plan.cones.rings[r];
            for (int c = ring.first; c < ring.first + ring.count; ++c) {
                const ConeRay ray = coneRay(receiver, basis * directions[std::size_t(c)]);
                if constexpr (requires { recorder.cone(ray, ring.weight, ring.tanHalf); }) recorder.cone(ray, ring.weight, ring.tanHalf);
                const ConeResult cone = marchCone<estimator>(world, sampler, ray, plan.ringSchedules[r], scratch, counts, recorder);
                if constexpr (requires { recorder.result(cone); }) recorder.result(cone);
                sum.irradiance += ring.weight * cone.radiance;
                sum.opacity += ring.weight * cone.opacity;
            }
        }
    }
    const float perSet = 1.0f / static_cast<float>(sets);
    return {sum.irradiance * (kPi * perSet), sum.opacity * perSet};
}

/// Towards what a mirror at the receiver would show; as long as toEye.
inline Vec3 mirrorDirection(const Vec3& normal, const Vec3& toEye)
{
    return 2.0f * glm::dot(normal, toEye) * normal - toEye;
}

/// The specular cone about the mirror direction; below the surface it sees nothing.
template <Estimator estimator, class Sampler, class Recorder>
Vec3 gatherSpecular(const ConeWorld& world, const Sampler& sampler, const GatherPlan& plan, const Receiver& receiver, const Vec3& toEye, float roughness,
                    MarchScratch& scratch, ConeCounts& counts, Recorder& recorder)
{
    const Vec3 mirror = mirrorDirection(receiver.normal, toEye);
    if (!(glm::dot(mirror, receiver.geometricNormal) > 0.0f)) return Vec3(0.0f);
    const MarchSchedule& schedule = plan.specularSchedule(roughness);
    const ConeRay ray = coneRay(receiver, glm::normalize(mirror));
    if constexpr (requires { recorder.cone(ray, 1.0f, schedule.tanHalf); }) recorder.cone(ray, 1.0f, schedule.tanHalf);
    const ConeResult cone = marchCone<estimator>(world, sampler, ray, schedule, scratch, counts, recorder);
    if constexpr (requires { recorder.result(cone); }) recorder.result(cone);
    return cone.radiance;
}

}  // namespace lrsm
