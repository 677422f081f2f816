#include "conetrace/frame/schedule.h"

#include "core/base/elementary.h"
#include "core/base/errors.h"

#include <algorithm>
#include <sstream>

namespace lrsm {
namespace {

MarchStep stepAt(const ConeSettings& settings, float tanHalf, float t)
{
    MarchStep step;
    step.middle = t;
    step.diameter = std::max(settings.march.minDiameterVoxels, 2.0f * t * tanHalf);
    const double level = std::max(0.0, log2Exact(double(step.diameter)) + double(settings.march.voxelLevelBias));
    step.level = static_cast<float>(level);
    step.tapWidth = static_cast<float>(exp2Exact(level));
    return step;
}

/// A step that float32 cannot add to the distance would end the cone in silence.
[[noreturn]] void refuseStep(const ConeSettings& settings, float t)
{
    std::ostringstream text;
    text << "the step is lost in float32 at " << t << " voxels from the receiver; raise step or min_diameter_voxels";
    std::ostringstream place;
    place << "settings step=" << settings.march.step << ", min_diameter_voxels=" << settings.march.minDiameterVoxels;
    throw InputError(place.str(), text.str());
}

/// From the last segment back: the least distance that any segment after it looks back to.
void settle(MarchSchedule& schedule, const LrsmGatherSettings& settings)
{
    if (schedule.steps.empty()) return;
    float settled = schedule.steps.back().end;
    for (auto step = schedule.steps.rbegin(); step != schedule.steps.rend(); ++step) {
        step->settled = settled;
        const float farthestDelay = (settings.emitterDelayTaps * step->tapWidth + settings.emitterDelayVoxels) / settings.emitterSlantCap;
        settled = std::min(settled, step->middle - farthestDelay);
    }
}

}  // namespace

MarchSchedule makeSchedule(const ConeSettings& settings, float tanHalf, float reachVoxels)
{
    MarchSchedule schedule;
    schedule.tanHalf = tanHalf;
    const bool slab = settings.march.estimator == Estimator::slab;

    float t = settings.march.startVoxels;
    if (slab && t > 0.0f) {
        MarchStep first = stepAt(settings, tanHalf, 0.5f * t);
        first.end = t;
        first.readVoxels = false;
        schedule.steps.push_back(first);
    }
    while (t < reachVoxels && static_cast<int>(schedule.steps.size()) < settings.march.maxSteps) {
        // The diameter at the segment's start gives its length: a segment grows with the cone.
        const float length = settings.march.step * std::max(settings.march.minDiameterVoxels, 2.0f * t * tanHalf);
        MarchStep step = stepAt(settings, tanHalf, slab ? t + 0.5f * length : t);
        step.begin = t;
        step.end = t + length;
        if (!(step.end > t)) refuseStep(settings, t);
        schedule.steps.push_back(step);
        t = step.end;
    }
    settle(schedule, settings.gather);
    return schedule;
}

}  // namespace lrsm
