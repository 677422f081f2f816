// Places, diameters and levels are held against double in apps/validate/equations/march_checks.cpp.
#include "conetrace/frame/schedule.h"
#include "core/base/errors.h"

#include "catch.h"

using namespace lrsm;

TEST_CASE("schedule: ends at maxSteps, a step that no longer changes the distance is refused, not taken for the end", "[conetrace][schedule]")
{
    ConeSettings settings;
    settings.march.maxSteps = 7;
    CHECK(makeSchedule(settings, 0.1f, 1e6f).steps.size() == 7);
    settings.march.maxSteps = 100000;
    settings.march.estimator = Estimator::paper;  // segments of `slab` are a voxel long at least
    settings.march.step = 1e-6f;
    settings.march.minDiameterVoxels = 1e-3f;
    settings.march.startVoxels = 1000.0f;
    CHECK_THROWS_AS(makeSchedule(settings, 0.0f, 1e6f), InputError);
}
