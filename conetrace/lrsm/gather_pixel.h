#pragma once

#include "conetrace/frame/pixel_cones.h"
#include "conetrace/lrsm/march_paper.h"
#include "conetrace/lrsm/march_slab.h"

/// How one pixel is gathered; shared by the picture and by --pixel, which only record differently.
namespace lrsm {

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
    cone.radiance *= unexposed(world.lrsms);
    return cone;
}

/// Diffuse cones of one pixel. With `active` a recorder is told the steps and layers too.
template <Estimator estimator, class Sampler, class Recorder>
PixelGather gatherDiffuse(const ConeWorld& world, const Sampler& sampler, const GatherPlan& plan, const Receiver& receiver, MarchScratch& scratch,
                          ConeCounts& counts, Recorder& recorder)
{
    const auto march = [&](const ConeRay& ray, const MarchSchedule& schedule) {
        return marchCone<estimator>(world, sampler, ray, schedule, scratch, counts, recorder);
    };
    return gatherDiffuse(plan, world.settings.set.setsPerPixel, receiver, march, recorder);
}

template <Estimator estimator, class Sampler, class Recorder>
Vec3 gatherSpecular(const ConeWorld& world, const Sampler& sampler, const GatherPlan& plan, const Receiver& receiver, const Vec3& direction, float roughness,
                    MarchScratch& scratch, ConeCounts& counts, Recorder& recorder)
{
    const auto march = [&](const ConeRay& ray, const MarchSchedule& schedule) {
        return marchCone<estimator>(world, sampler, ray, schedule, scratch, counts, recorder);
    };
    return gatherSpecular(plan, receiver, direction, roughness, march, recorder);
}

}  // namespace lrsm
