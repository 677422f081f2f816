#include "apps/validate/extremes/extremes.h"

#include "catch.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

using namespace lrsm;

namespace {

void show(const ExtremesReport& report)
{
    for (const ExtremeResult& r : report.results) {
        if (r.outcome == Outcome::broken) WARN(r.group << ", " << r.name << ", " << r.storage << ": " << r.detail);
        if (r.outcome == Outcome::skipped) WARN("SKIPPED " << r.name << ": " << r.detail);
    }
}

/// Every case of these groups in every storage mode holds or is refused clearly.
void checkGroup(const std::string& only, std::size_t least)
{
    const ExtremesReport report = runExtremes({only, {}});
    show(report);
    CHECK(report.held());
    CHECK(report.results.size() >= least);
}

const ExtremeCurve& curveNamed(const ExtremesReport& report, const std::string& name)
{
    for (const ExtremeCurve& curve : report.curves)
        if (curve.name == name) return curve;
    FAIL("no curve " << name);
    return report.curves.front();
}

}  // namespace

TEST_CASE("extremes: moments, layers, storage and depth ranges hold or are refused", "[extremes][eq12]")
{
    checkGroup("moments", 13);
    checkGroup("depth range", 60);
    checkGroup("radiance ", 30);
    checkGroup("layer", 25);
}

TEST_CASE("extremes: files hold or are refused in one clear line", "[extremes][files]")
{
    checkGroup("view: ", 30);
    checkGroup("glTF: ", 35);
}

TEST_CASE("extremes: triangles that should not be leave every pass as it is, or finite", "[extremes][geometry]")
{
    checkGroup("NaN", 10);
    checkGroup("a segment", 3);
    checkGroup("larger than the grid", 1);
    checkGroup("flat", 6);
    checkGroup("times 2^-33", 3);
    checkGroup("times 2^33", 3);
}

TEST_CASE("extremes: narrow spots keep their light, coincident ones add up, one inside a block stays there", "[extremes][lights]")
{
    checkGroup("a spot of", 15);
    checkGroup("two coincident lights", 3);
    checkGroup("inside geometry", 3);
    checkGroup("at the point seen", 3);
}

TEST_CASE("extremes: the curves say from where accuracy degrades", "[extremes][curves]")
{
    // From above and below, so that neither a worse pipeline nor a careless curve passes.
    const ExtremesReport report = runExtremes({"radiance, ", {}});
    CHECK(curveNamed(report, "radiance, upwards").degradesFrom == Approx(1e5));     // half ends at 65504
    CHECK(curveNamed(report, "radiance, downwards").degradesFrom == Approx(1e-5));  // its normal numbers at 6.1e-5
    CHECK(curveNamed(report, "radiance, downwards").degradesDownwards);
    const ExtremesReport depth = runExtremes({"depth ratio", {}});
    CHECK(curveNamed(depth, "depth ratio").degradesFrom == Approx(1e6));
    const ExtremesReport coverage = runExtremes({"coverage", {}});
    CHECK(curveNamed(coverage, "coverage").degradesFrom == Approx(262144.0));  // 4^9: alpha below half of UNORM16's step
    for (const ExtremesReport* each : {&report, &depth, &coverage})
        for (const ExtremeCurve& curve : each->curves) {
            CHECK(curve.sentence.find("degrades from") != std::string::npos);
            for (const ChartSeries& series : curve.series) CHECK(series.x.size() == series.y.size());
        }
}

// About a minute: `test_extremes "[.long]"`, or `lrsm validate --extremes`. LRSM_EXTREMES picks cases by a part of their name.
TEST_CASE("extremes: the whole catalogue", "[.long][extremes]")
{
    const char* only = std::getenv("LRSM_EXTREMES");
    const ExtremesReport report = runExtremes({only ? only : "", {}});
    show(report);
    for (const ExtremeResult& r : report.results) std::cout << r.group << " | " << r.name << " | " << r.storage << " | " << r.detail << "\n";
    for (const ExtremeCurve& c : report.curves) std::cout << "curve " << c.name << ": " << c.sentence << "\n";
    CHECK(report.held());
}
