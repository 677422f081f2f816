#pragma once

#include "conetrace/frame/cones.h"
#include "conetrace/lrsm/gather.h"
#include "conetrace/lrsm/march_paper.h"
#include "conetrace/lrsm/march_slab.h"

/// What the gather makes once a frame, and how it traces one pixel; shared by the picture and by --pixel, which only record differently.
namespace lrsm {

/// Directions, schedules and tables of one frame.
struct GatherPlan {
    ConeSet cones;
    std::vector<MarchSchedule> ringSchedules;      ///< one a ring
    std::vector<MarchSchedule> specularSchedules;  ///< by roughness class; one when the aperture is fixed, none without specular cones
    NormalCdf phi;
    std::size_t longestSchedule = 0;
};

GatherPlan planGather(const OpacityPyramid& opacity, const Requirements& needs, const ConeSettings& settings);

/// One surface, ready for cones.
struct Receiver {
    Vec3 position{0.0f};
    Vec3 geometricNormal{0.0f}, normal{0.0f};
    Vec3 originVoxels{0.0f}, originWorld{0.0f};  ///< the cones' apex: off the surface by normalOffsetVoxels
    int rotation = 0;
};
Receiver receiverAt(const GBuffer& gbuffer, const VoxelFrame& frame, const ConeSettings& settings, int x, int y);

struct PixelGather {
    Vec3 irradiance{0.0f};
    float opacity = 0.0f;
};

/// The estimator seam: all else is common. A third estimator is one more case.
template <Estimator estimator, class Sampler, class Recorder>
ConeResult marchCone(const ConeWorld& world, const Sampler& sampler, const ConeRay& ray, const MarchSchedule& schedule, MarchScratch& scratch,
                     ConeCounts& counts, Recorder& recorder)
{
    if constexpr (estimator == Estimator::slab)
        return marchSlab(world, sampler, ray, schedule, scratch, counts, recorder);
    else
        return marchPaper(world, sampler, ray, schedule, scratch, counts, recorder);
}

inline ConeRay coneRay(const Receiver& receiver, const Vec3& direction)
{
    return {receiver.originWorld, receiver.originVoxels, direction, receiver.geometricNormal};
}

/// A recorder is told what it has functions for: cone() before a cone, result() after it; with `active` also its steps and layers.

/// Diffuse cones of one pixel: E = pi * sum w_c I_c, averaged over setsPerPixel rotations.
template <Estimator estimator, class Sampler, class Recorder>
PixelGather gatherDiffuse(const ConeWorld& world, const Sampler& sampler, const GatherPlan& plan, const Receiver& receiver, MarchScratch& scratch,
                          ConeCounts& counts, Recorder& recorder)
{
    const Mat3 frame = frameFromNormal(receiver.normal);
    const int sets = world.settings.setsPerPixel;
    PixelGather sum;
    for (int s = 0; s < sets; ++s) {
        const auto directions = plan.cones.rotation((receiver.rotation + s * kRotations / sets) % kRotations);
        for (std::size_t r = 0; r < plan.cones.rings.size(); ++r) {
            const ConeRing& ring = plan.cones.rings[r];
            for (int c = ring.first; c < ring.first + ring.count; ++c) {
                const ConeRay ray = coneRay(receiver, frame * directions[std::size_t(c)]);
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

/// Into [0, 1]; NaN becomes 0.
inline float roughnessClass(float roughness)
{
    return roughness > 0.0f ? std::min(roughness, 1.0f) : 0.0f;
}

/// The specular cone about the mirror direction; below the surface it sees nothing.
template <Estimator estimator, class Sampler, class Recorder>
Vec3 gatherSpecular(const ConeWorld& world, const Sampler& sampler, const GatherPlan& plan, const Receiver& receiver, const Vec3& toEye, float roughness,
                    MarchScratch& scratch, ConeCounts& counts, Recorder& recorder)
{
    const Vec3 mirror = 2.0f * glm::dot(receiver.normal, toEye) * receiver.normal - toEye;
    if (!(glm::dot(mirror, receiver.geometricNormal) > 0.0f)) return Vec3(0.0f);
    const auto last = static_cast<float>(plan.specularSchedules.size() - 1);
    const MarchSchedule& schedule = plan.specularSchedules[static_cast<std::size_t>(roughnessClass(roughness) * last + 0.5f)];
    const ConeRay ray = coneRay(receiver, glm::normalize(mirror));
    if constexpr (requires { recorder.cone(ray, 1.0f, schedule.tanHalf); }) recorder.cone(ray, 1.0f, schedule.tanHalf);
    const ConeResult cone = marchCone<estimator>(world, sampler, ray, schedule, scratch, counts, recorder);
    if constexpr (requires { recorder.result(cone); }) recorder.result(cone);
    return cone.radiance;
}

}  // namespace lrsm
