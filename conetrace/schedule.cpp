#include "conetrace/schedule.h"

#include "core/base/elementary.h"

#include <algorithm>

namespace lrsm {
namespace {

MarchStep stepAt(const ConeSettings& settings, float tanHalf, float t)
{
    MarchStep step;
    step.middle = t;
    step.diameter = std::max(settings.minDiameterVoxels, 2.0f * t * tanHalf);
    const double level = std::max(0.0, log2Exact(double(step.diameter)) + double(settings.voxelLevelBias));
    step.level = static_cast<float>(level);
    step.tapWidth = static_cast<float>(exp2Exact(level));
    return step;
}

}  // namespace

MarchSchedule makeSchedule(const ConeSettings& settings, float tanHalf, float reachVoxels)
{
    MarchSchedule schedule;
    schedule.tanHalf = tanHalf;
    const bool slab = settings.estimator == Estimator::slab;

    float t = settings.startVoxels;
    if (slab && t > 0.0f) {
        MarchStep first = stepAt(settings, tanHalf, 0.5f * t);
        first.end = t;
        first.readVoxels = false;
        schedule.steps.push_back(first);
    }
    while (t < reachVoxels && static_cast<int>(schedule.steps.size()) < settings.maxSteps) {
        // The diameter at the segment's start gives its length: a segment grows with the cone.
        const float length = settings.step * std::max(settings.minDiameterVoxels, 2.0f * t * tanHalf);
        MarchStep step = stepAt(settings, tanHalf, slab ? t + 0.5f * length : t);
        step.begin = t;
        step.end = t + length;
        if (!(step.end > t)) break;  // t has outgrown its own precision
        schedule.steps.push_back(step);
        t = step.end;
    }
    return schedule;
}

}  // namespace lrsm
