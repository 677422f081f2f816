#include "apps/validate/extremes/catalogue.h"

#include "core/base/errors.h"

#include "catch.h"

#include <cmath>

using namespace lrsm;
using namespace lrsm::extremes;

namespace {

/// A case with a planted defect, through the runner.
ExtremeResult planted(const std::function<void(Mode, Probe&)>& run, bool mustRefuse = false)
{
    const Group group{"planted", {}};
    return runCase(group, {"defect", "", "", run, false, mustRefuse}, Mode::gpuD3d);
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the runner finds a planted NaN, an infinity, a value past its bound, and a NaN as a measured value", "[extremes][seeded]")
{
    for (const float bad : {std::nanf(""), kInfinity, -kInfinity}) {
        const ExtremeResult result = planted([bad](Mode, Probe& probe) {
            Image<Vec3> image(40, 30);
            image.at(39, 29).y = bad;
            probe.output("planted pass", image);
        });
        CHECK(result.outcome == Outcome::broken);
        CHECK(contains(result.detail, "1 NaN or infinite values leave planted pass"));
    }
    CHECK(planted([](Mode, Probe& probe) { probe.bound("error", -0.2, 0.1); }).outcome == Outcome::broken);
    CHECK(planted([](Mode, Probe& probe) { probe.bound("error", double(std::nanf("")), 0.1); }).outcome == Outcome::broken);
    CHECK(planted([](Mode, Probe& probe) { probe.bound("error", 0.1, 0.1); }).outcome == Outcome::held);
}

TEST_CASE("the runner finds results that differ from run to run, in value, output or refusal", "[extremes][seeded]")
{
    int calls = 0;
    CHECK(contains(planted([&](Mode, Probe& probe) { probe.bound("error", 1e-9 * ++calls, 0.1); }).detail, "two runs differ"));
    CHECK(contains(planted([&](Mode, Probe& probe) {
                       Image<Vec3> image(4, 3);
                       image.at(0, 0).x = float(++calls);
                       probe.output("pass", image);
                   }).detail,
                   "two runs differ"));
    CHECK(contains(planted([&](Mode, Probe&) { throw InputError("place " + std::to_string(++calls), "why it cannot be"); }, true).detail, "two runs differ"));
}

TEST_CASE("the runner finds a refusal that is not due, one that is missing, one that is unclear, and any other exception", "[extremes][seeded]")
{
    CHECK(contains(planted([](Mode, Probe&) { throw InputError("somewhere", "for no reason at all"); }).detail, "refused: somewhere"));
    CHECK(contains(planted([](Mode, Probe&) {}, true).detail, "taken, where a refusal is due"));
    CHECK(contains(planted([](Mode, Probe&) { throw InputError("no"); }, true).detail, "unclear"));
    CHECK(contains(planted([](Mode, Probe&) { throw InputError("two\nlines: of text"); }, true).detail, "unclear"));
    CHECK(contains(planted([](Mode, Probe&) { throw std::runtime_error("boom"); }).detail, "threw boom"));
    CHECK(
        contains(planted([](Mode, Probe& probe) { probe.refuses("it", "nonsense", [] { throw InputError("place", "another reason"); }); }).detail, "unclear"));
    CHECK(planted([](Mode, Probe&) { throw InputError("place", "a good reason"); }, true).outcome == Outcome::refused);
    CHECK(planted([](Mode, Probe&) { throw MachineError("grid", "not enough memory"); }).outcome == Outcome::skipped);
}

TEST_CASE("counting of NaNs and infinities sees every field of every pass's output", "[extremes][seeded]")
{
    const float nan = std::nanf("");
    Rsm rsm;
    rsm.texels = Image<RsmTexel>(2, 2);
    rsm.depthLinear = Image<float>(2, 2);
    CHECK(countNonFinite(rsm) == 0);
    rsm.texels.at(1, 1).nDotL = nan;
    rsm.texels.at(0, 0).radiance.x = kInfinity;
    rsm.depthLinear.at(0, 1) = -kInfinity;
    CHECK(countNonFinite(rsm) == 3);

    Lrsm lrsm;
    lrsm.texels.resize(3);
    lrsm.texels[2].depth[3] = nan;
    CHECK(countNonFinite(lrsm) == 1);

    GBuffer gbuffer;
    for (Image<Vec3>* image : {&gbuffer.position, &gbuffer.geometricNormal, &gbuffer.normal, &gbuffer.albedo, &gbuffer.specularColor}) {
        *image = Image<Vec3>(1, 1);
        image->texels[0].z = nan;
    }
    for (Image<float>* image : {&gbuffer.roughness, &gbuffer.depthLinear}) *image = Image<float>(1, 1, nan);
    CHECK(countNonFinite(gbuffer) == 7);

    Gathered gathered;
    gathered.irradiance = gathered.specular = Image<Vec3>(1, 1, Vec3(nan));
    gathered.opacity = Image<float>(1, 1, kInfinity);
    CHECK(countNonFinite(gathered) == 7);

    OpacityPyramid pyramid;
    pyramid.float32 = {0.0f, nan, std::numeric_limits<float>::max(), std::numeric_limits<float>::denorm_min()};
    CHECK(countNonFinite(pyramid) == 1);
}

TEST_CASE("a curve says where it crosses its bound, in either direction, or that it does not", "[extremes][seeded]")
{
    CurvePlan plan{"planted",
                   "x",
                   "error",
                   {1, 10, 100, 1000},
                   {Mode::gpuD3d, Mode::float32},
                   [](Mode mode, double x) { return mode == Mode::float32 ? 0.0 : 1e-3 * x; },
                   0.05,
                   false,
                   "A planted error"};
    ExtremeCurve curve = drawCurve(plan);
    CHECK(curve.degradesFrom == 100.0);
    CHECK(contains(curve.sentence, "A planted error degrades from x = 100 on"));
    CHECK(curve.series[1].y[0] > 0.0);  // an error of 0 has a place on a log scale
    plan.bound = 10.0;
    CHECK(std::isinf(drawCurve(plan).degradesFrom));
    CHECK(contains(drawCurve(plan).sentence, "stays within"));
    plan.y = [](Mode, double x) { return x > 50.0 ? 0.0 : double(std::nanf("")); };
    plan.degradesDownwards = true;
    CHECK(drawCurve(plan).degradesFrom == 10.0);
}
