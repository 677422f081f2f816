#include "core/base/errors.h"
#include "quick_report.h"

#include "catch.h"

#include <algorithm>

using namespace lrsm;
using test::quick;

TEST_CASE("every equation keeps its stated bound where the search can reach", "[equations]")
{
    const EquationReport& report = test::quickReport();
    for (const EquationCheck& check : report.checks) {
        CAPTURE(check.equation, check.function, check.bound.name, check.bound.value, check.worst, check.worstInput);
        CHECK(check.holds());
        CHECK(!check.oracle.empty());
        CHECK(!check.domain.empty());
        CHECK(check.bound.name != std::string());
        CHECK(!check.errorKind.empty());
        CHECK(check.meanError <= check.worst);
    }
    CHECK(report.holds());
}

TEST_CASE("the same figures come out on every run", "[equations]")
{
    EquationOptions options = quick(0.01);
    options.equation = "8";
    const EquationReport first = checkEquations(options), second = checkEquations(options);
    REQUIRE(first.checks.size() == second.checks.size());
    for (std::size_t i = 0; i < first.checks.size(); ++i) {
        CHECK(first.checks[i].worst == second.checks[i].worst);
        CHECK(first.checks[i].worstInput == second.checks[i].worstInput);
        CHECK(first.checks[i].evaluations == second.checks[i].evaluations);
        CHECK(first.checks[i].nanoseconds == 0.0);
    }
}

TEST_CASE("one equation alone, and a name that is none", "[equations]")
{
    EquationOptions options = quick(0.01);
    options.equation = "table1";
    const EquationReport report = checkEquations(options);
    CHECK(!report.checks.empty());
    CHECK(std::all_of(report.checks.begin(), report.checks.end(), [](const EquationCheck& check) { return check.equation == "table1"; }));
    options.equation = "16";
    CHECK_THROWS_AS(checkEquations(options), InputError);
}

TEST_CASE("a check that compared nothing, or met NaN, does not hold", "[equations]")
{
    EquationCheck check;
    check.bound.value = 1.0;
    CHECK(!check.holds());
    check.evaluations = 1;
    CHECK(check.holds());
    check.worst = std::numeric_limits<double>::quiet_NaN();
    CHECK(!check.holds());
    CHECK(!EquationReport{}.holds());
}
