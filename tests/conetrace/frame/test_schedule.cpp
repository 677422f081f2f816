#include "conetrace/frame/schedule.h"
#include "core/base/errors.h"

#include "catch.h"

#include <cmath>

using namespace lrsm;

TEST_CASE("schedule: slab segments tile the cone from its apex, without gap or overlap", "[conetrace][schedule]")
{
    ConeSettings settings;
    settings.estimator = Estimator::slab;
    const float tanHalf = GENERATE(0.01f, 0.3f, 1.7f);
    const MarchSchedule schedule = makeSchedule(settings, tanHalf, 500.0f);
    REQUIRE(schedule.steps.size() > 3);
    CHECK(schedule.steps.front().begin == 0.0f);
    CHECK(!schedule.steps.front().readVoxels);
    CHECK(schedule.steps.back().end >= 500.0f);
    for (std::size_t i = 0; i < schedule.steps.size(); ++i) {
        const MarchStep& s = schedule.steps[i];
        if (i > 0) REQUIRE(s.begin == schedule.steps[i - 1].end);
        REQUIRE(s.middle == Approx(0.5f * (s.begin + s.end)));
        REQUIRE(s.diameter == Approx(std::max(settings.minDiameterVoxels, 2 * s.middle * tanHalf)));
        REQUIRE(double(s.level) == Approx(std::max(0.0, std::log2(double(s.diameter)) + double(settings.voxelLevelBias))).margin(double(kVoxelLevelMaxError)));
        REQUIRE(double(s.tapWidth) == Approx(std::exp2(double(s.level))));
    }
}

TEST_CASE("schedule: the paper's spheres are a fixed fraction of their diameter apart", "[conetrace][schedule]")
{
    ConeSettings settings;
    settings.estimator = Estimator::paper;
    settings.step = 0.25f;
    const MarchSchedule schedule = makeSchedule(settings, 0.577f, 300.0f);
    CHECK(schedule.steps.front().middle == settings.startVoxels);
    for (std::size_t i = 1; i < schedule.steps.size(); ++i) {
        const MarchStep& before = schedule.steps[i - 1];
        REQUIRE(schedule.steps[i].middle - before.middle == Approx(0.25f * before.diameter).epsilon(1e-4));
    }
}

TEST_CASE("schedule: ends at maxSteps; a step that no longer changes the distance is refused, not taken for the end", "[conetrace][schedule]")
{
    ConeSettings settings;
    settings.maxSteps = 7;
    CHECK(makeSchedule(settings, 0.1f, 1e6f).steps.size() == 7);
    settings.maxSteps = 100000;
    settings.step = 1e-6f;
    settings.minDiameterVoxels = 1e-3f;
    settings.startVoxels = 1000.0f;
    CHECK_THROWS_AS(makeSchedule(settings, 0.0f, 1e6f), InputError);
}
