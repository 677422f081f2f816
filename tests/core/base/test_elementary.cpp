// Errors are searched for in apps/validate/equations/elementary_checks.cpp; here are the edges.
#include "core/base/elementary.h"

#include "catch.h"

#include <cmath>

using namespace lrsm;

TEST_CASE("elementary functions at their edges", "[core][elementary]")
{
    CHECK(std::isnan(sinCos(std::nan("")).sin));
    CHECK(std::isnan(log2Exact(-1.0)));
    CHECK(std::isinf(log2Exact(0.0)));
    CHECK(exp2Exact(2000.0) == std::numeric_limits<double>::infinity());
    CHECK(exp2Exact(-2000.0) == 0.0);
    for (int e = -100; e <= 100; ++e) CHECK(exp2Exact(e) == std::ldexp(1.0, e));
    CHECK(power(0.0, 2.4) == 0.0);
    CHECK(power(9.0, 0.5) == Approx(3.0).epsilon(1e-14));
    CHECK(std::isnan(fastExp2(std::nanf(""))));

    const double pi = 3.14159265358979323846;
    CHECK(arcTangent2(0.0, 1.0) == 0.0);
    CHECK(arcTangent2(1.0, 0.0) == pi / 2);
    CHECK(arcTangent2(-1.0, 0.0) == -pi / 2);
    CHECK(arcTangent2(0.0, -1.0) == pi);
    CHECK(arcTangent2(0.0, 0.0) == 0.0);
    CHECK(std::abs(arcTangent2(1.0, 1.0) - pi / 4) <= kArcTangentMaxError);
    CHECK(std::isnan(arcTangent2(std::nan(""), 1.0)));
}
