#include "conetrace/frame/gather_plan.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr int kRoughnessClasses = 64;

}  // namespace

const MarchSchedule& GatherPlan::specularSchedule(float roughness) const
{
    const float clamped = roughness > 0.0f ? std::min(roughness, 1.0f) : 0.0f;
    const auto last = static_cast<float>(specularSchedules.size() - 1);
    return specularSchedules[static_cast<std::size_t>(clamped * last + 0.5f)];
}

GatherPlan planGather(const ConeSettings& settings, const Requirements& needs, int gridResolution)
{
    GatherPlan plan;
    plan.cones = makeConeSet(settings);
    const float reach = gridDiagonal(gridResolution);
    for (const ConeRing& ring : plan.cones.rings) plan.ringSchedules.push_back(makeSchedule(settings, ring.tanHalf, reach));
    if (needs.specular) {
        plan.lobes = SpecularLobes(settings);
        const int classes = settings.specular.aperture == SpecularAperture::fixed ? 1 : kRoughnessClasses;
        for (int i = 0; i < classes; ++i) {
            const float roughness = classes > 1 ? static_cast<float>(i) / static_cast<float>(classes - 1) : 0.0f;
            plan.specularSchedules.push_back(makeSchedule(settings, specularTanHalf(settings, roughness), reach));
        }
    }
    return plan;
}

}  // namespace lrsm
