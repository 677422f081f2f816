#include "conetrace/frame/schedule.h"

#include "core/base/elementary.h"
#include "core/base/errors.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace lrsm {
namespace {

/// The sphere of `paper` at t, and of `slab` within the receiver's own voxels.
MarchStep stepAt(const ConeSettings& settings, float tanHalf, float t)
{
    MarchStep step;
    step.middle = step.begin = t;
    step.diameter = std::max(settings.march.minDiameterVoxels, 2.0f * t * tanHalf);
    step.end = t + settings.march.step * step.diameter;
    const double level = std::max(0.0, log2Exact(double(step.diameter)) + double(settings.march.voxelLevelBias));
    step.level = static_cast<float>(level);
    step.tapWidth = static_cast<float>(exp2Exact(level));
    return step;
}

/// The segment of `slab` that begins at t.
MarchStep segmentAt(const ConeSettings& settings, float tanHalf, float t)
{
    const float diameter = std::max(settings.march.minDiameterVoxels, 2.0f * t * tanHalf);
    const double level = std::max(0.0, std::floor(log2Exact(double(diameter)) + double(settings.march.voxelLevelBias)));
    MarchStep step;
    step.level = static_cast<float>(level);
    step.tapWidth = static_cast<float>(exp2Exact(level));
    step.taps = std::max(1, static_cast<int>(settings.march.step * diameter / step.tapWidth + 0.5f));
    step.begin = t;
    step.end = t + step.tapWidth * static_cast<float>(step.taps);
    step.middle = 0.5f * (t + step.end);
    step.diameter = std::max(settings.march.minDiameterVoxels, 2.0f * step.middle * tanHalf);
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
    float settled = kInfinity;
    for (auto step = schedule.steps.rbegin(); step != schedule.steps.rend(); ++step) {
        const float farthestDelay = (settings.emitterDelayTaps * step->tapWidth + settings.emitterDelayVoxels) / settings.emitterSlantCap;
        settled = std::min(settled, step->begin - kCrossingSlackTaps * step->tapWidth - farthestDelay);
        step->settled = settled;
    }
}

/// Numbers the taps along the cone and says where each begins.
void layTaps(MarchSchedule& schedule)
{
    schedule.edges.push_back(schedule.steps.empty() ? 0.0f : schedule.steps.front().begin);
    for (MarchStep& step : schedule.steps) {
        step.firstTap = static_cast<int>(schedule.edges.size()) - 1;
        for (int k = 1; k < step.taps; ++k) schedule.edges.push_back(step.begin + step.tapWidth * static_cast<float>(k));
        schedule.edges.push_back(step.end);
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
        first.begin = 0.0f;
        first.end = t;
        first.readVoxels = false;
        schedule.steps.push_back(first);
    }
    while (t < reachVoxels && static_cast<int>(schedule.steps.size()) < settings.march.maxSteps) {
        if (!(settings.march.step > 0.0f && settings.march.step < kInfinity)) refuseStep(settings, t);
        MarchStep step = slab ? segmentAt(settings, tanHalf, t) : stepAt(settings, tanHalf, t);
        if (!(step.end > t)) refuseStep(settings, t);
        schedule.steps.push_back(step);
        t = step.end;
    }
    if (slab) {
        settle(schedule, settings.gather);
        layTaps(schedule);
    }
    return schedule;
}

}  // namespace lrsm
