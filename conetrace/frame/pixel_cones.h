#pragma once

#include "conetrace/frame/cone.h"
#include "conetrace/frame/gather_plan.h"
#include "conetrace/frame/receiver.h"

#include <utility>

/// The cones of one pixel, whatever follows them: `march(ray, schedule)` gives a ConeResult.
/// A recorder is told what it has functions for: cone() before a cone, result() after it.
namespace lrsm {

struct PixelGather {
    Vec3 irradiance{0.0f};
    float opacity = 0.0f;
};

inline ConeRay coneRay(const Receiver& receiver, const Vec3& direction)
{
    return {.originWorld = receiver.originWorld, .originVoxels = receiver.originVoxels, .direction = direction, .receiverNormal = receiver.geometricNormal};
}

template <class March, class Recorder>
ConeResult recordedCone(const March& march, const ConeRay& ray, float weight, const MarchSchedule& schedule, Recorder& recorder)
{
    if constexpr (requires { recorder.cone(ray, weight, schedule.tanHalf); }) recorder.cone(ray, weight, schedule.tanHalf);
    const ConeResult cone = march(ray, schedule);
    if constexpr (requires { recorder.result(cone); }) recorder.result(cone);
    return cone;
}

/// Diffuse cones: E = pi * sum w_c I_c, averaged over setsPerPixel rotations.
template <class March, class Recorder>
PixelGather gatherDiffuse(const GatherPlan& plan, int setsPerPixel, const Receiver& receiver, const March& march, Recorder& recorder)
{
    const Mat3 basis = basisFromNormal(receiver.normal);
    PixelGather sum;
    for (int s = 0; s < setsPerPixel; ++s) {
        const auto directions = plan.cones.rotation((receiver.rotation + s * kRotations / setsPerPixel) % kRotations);
        for (std::size_t r = 0; r < plan.cones.rings.size(); ++r) {
            const ConeRing& ring = plan.cones.rings[r];
            for (int c = ring.first; c < ring.first + ring.count; ++c) {
                const ConeRay ray = coneRay(receiver, basis * directions[std::size_t(c)]);
                const ConeResult cone = recordedCone(march, ray, ring.weight, plan.ringSchedules[r], recorder);
                sum.irradiance += ring.weight * cone.radiance;
                sum.opacity += ring.weight * cone.opacity;
            }
        }
    }
    const float perSet = 1.0f / static_cast<float>(setsPerPixel);
    return {sum.irradiance * (kPi * perSet), sum.opacity * perSet};
}

/// The specular cone of a direction of the lobe (lobe.h); below the surface it sees nothing.
template <class March, class Recorder>
Vec3 gatherSpecular(const GatherPlan& plan, const Receiver& receiver, const Vec3& direction, float roughness, const March& march, Recorder& recorder)
{
    if (!(glm::dot(direction, receiver.geometricNormal) > 0.0f)) return Vec3(0.0f);
    return recordedCone(march, coneRay(receiver, direction), 1.0f, plan.specularSchedule(roughness), recorder).radiance;
}

}  // namespace lrsm
