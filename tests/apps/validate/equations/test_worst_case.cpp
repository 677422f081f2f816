#include "apps/validate/equations/worst_case.h"

#include "catch.h"

using namespace lrsm;

TEST_CASE("ULP steps go through zero, and stop at the largest float", "[equations][search]")
{
    CHECK(moveByUlps(1.0f, 1) == std::nextafter(1.0f, 2.0f));
    CHECK(moveByUlps(1.0f, -1) == std::nextafter(1.0f, 0.0f));
    CHECK(moveByUlps(0.0f, 1) == std::numeric_limits<float>::denorm_min());
    CHECK(moveByUlps(-0.0f, -1) == -std::numeric_limits<float>::denorm_min());
    CHECK(moveByUlps(std::numeric_limits<float>::denorm_min(), -2) == -std::numeric_limits<float>::denorm_min());
    CHECK(moveByUlps(std::numeric_limits<float>::max(), 5) == std::numeric_limits<float>::max());
    CHECK(moveByUlps(-std::numeric_limits<double>::max(), -5) == -std::numeric_limits<double>::max());
    CHECK(moveByUlps(-2.5, 3) == std::nextafter(std::nextafter(std::nextafter(-2.5, 0.0), 0.0), 0.0));
}

TEST_CASE("the search finds a defect on a single float beside a planted boundary", "[equations][search]")
{
    const SearchSpace<float, 1> space{{{{0.0f, 10.0f}}}, {{3.0f}}};
    const float spike = std::nextafter(3.0f, 4.0f);
    const auto worst = findWorst(space, {1000, 1000}, [&](const auto& in) { return in[0] == spike ? 1.0 : 1e-3; });
    CHECK(worst.error == 1.0);
    CHECK(worst.input[0] == spike);
}

TEST_CASE("the search climbs to a narrow peak that no sweep would meet", "[equations][search]")
{
    // Width 1e-4 of each of three axes: one sample in 10^12 would fall into it.
    const SearchSpace<float, 3> space{{{{-1.0f, 1.0f}, {0.0f, 8.0f}, {1e-6f, 1.0f, Spacing::logarithmic}}}};
    const auto error = [](const std::array<float, 3>& in) {
        const double x = double(in[0]) - 0.3, y = (double(in[1]) - 5.0) / 8.0, z = std::log2(double(in[2])) / 20.0 + 0.7;
        return 1.0 / (1e-4 + std::sqrt(x * x + y * y + z * z));
    };
    const auto worst = findWorst(space, {4000, 40000}, error);
    CHECK(worst.error > 0.9e4);
    CHECK(worst.mean() < 10.0);
}

TEST_CASE("NaN is the worst error of all, and inputs out of the question are left out", "[equations][search]")
{
    const SearchSpace<double, 1> space{{{{0.0, 1.0}}}};
    CHECK(findWorst(space, {100, 0}, [](const auto& in) { return in[0] > 0.9 ? std::nan("") : 0.0; }).error == std::numeric_limits<double>::infinity());
    const auto none = findWorst(space, {100, 100}, [](const auto&) { return -1.0; });
    CHECK(none.error == -1.0);
    CHECK(none.swept == 0);
    CHECK(none.mean() == 0.0);
}

TEST_CASE("points stay within the domain", "[equations][search]")
{
    const SearchSpace<float, 2> space{{{{-2.0f, 3.0f}, {0.5f, 4.0f, Spacing::signedLogarithmic}}}, {{3.0f, 4.0f}, {-2.0f, -4.0f}}};
    bool inside = true, negative = false;
    findWorst(space, {2000, 4000}, [&](const std::array<float, 2>& in) {
        inside = inside && in[0] >= -2.0f && in[0] <= 3.0f && std::abs(in[1]) <= 4.0f;
        negative = negative || in[1] < -0.5f;
        return double(in[0]) + std::abs(double(in[1]));
    });
    CHECK(inside);
    CHECK(negative);
}
