// The errors of Phi and V are searched for in apps/validate/equations/gaussian_checks.cpp; here are the traps.
#include "lrsm/gaussian_visibility.h"

#include <catch.h>

using namespace lrsm;

TEST_CASE("a table is right at its own entries, the last cell included", "[lrsm][eq12]")
{
    const NormalCdf phi(GaussianMethod::table, 11);  // entries at -5, -4, ... 5
    for (const float x : {std::nextafter(-5.0f, 0.0f), -4.0f, -3.0f, -1.0f, 0.0f, 2.0f, 4.0f, std::nextafter(5.0f, 0.0f)})
        CHECK(std::abs(static_cast<double>(phi(x)) - normalCdfExact(x)) <= static_cast<double>(kTableCdfRoundingError));
}

TEST_CASE("the polynomial Phi is odd about 1/2, within [0, 1] and rises within its error", "[lrsm][eq12]")
{
    const NormalCdf phi;
    float highest = 0.0f;
    for (float x = -7.0f; x < 7.0f; x += 0.00037f) {
        const float y = phi(x);
        REQUIRE(y >= 0.0f);
        REQUIRE(y <= 1.0f);
        REQUIRE(std::abs(y + phi(-x) - 1.0f) <= 0x1p-23f);
        REQUIRE(y >= highest - 2.0f * kPolynomialCdfMaxError);
        highest = std::max(highest, y);
    }
    CHECK(phi(0.0f) == 0.5f);
}

TEST_CASE("Phi at infinity is 0 or 1 within the bound, and NaN stays NaN", "[lrsm][eq12]")
{
    const auto method = GENERATE(GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact);
    const NormalCdf phi(method, 256);
    for (const float far : {1e3f, 1e30f, kInfinity}) {
        CHECK(std::abs(phi(-far)) <= phi.maxError());
        CHECK(std::abs(phi(far) - 1.0f) <= phi.maxError());
    }
    CHECK(std::isnan(phi(std::numeric_limits<float>::quiet_NaN())));
}

TEST_CASE("table sizes beyond the limits are clamped", "[lrsm][eq12]")
{
    CHECK(NormalCdf(GaussianMethod::table, -3).maxError() == tableCdfMaxError(2));
    CHECK(NormalCdf(GaussianMethod::table, 1 << 20).maxError() == tableCdfMaxError(65536));
}

TEST_CASE("windows side by side tile the distribution: fractions sum to 1", "[lrsm][eq12]")
{
    const auto method = GENERATE(GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact);
    const NormalCdf phi(method, 1024);
    double sum = 0.0;
    for (int i = 0; i < 64; ++i) sum += static_cast<double>(gaussianVisibility(phi, 0.4f, 0.01f, (static_cast<float>(i) + 0.5f) / 32.0f - 0.5f, 1.0f / 64.0f));
    CHECK(std::abs(sum - 1.0) <= 4e-6);
}

TEST_CASE("the smallest variances approach the step of none, and NaN stays NaN", "[lrsm][eq12]")
{
    const auto method = GENERATE(GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact);
    const NormalCdf phi(method);
    const float tiny = std::numeric_limits<float>::denorm_min(), nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(gaussianVisibility(phi, 0.5f, tiny, 0.25f, 0.25f) == Approx(0.5f));
    CHECK(gaussianVisibility(phi, 0.5f, tiny, 0.5f, 1e-3f) == Approx(1.0f));
    CHECK(gaussianVisibility(phi, 0.5f, tiny, 0.25f, 0.1f) == 0.0f);
    CHECK(std::isnan(gaussianVisibility(phi, nan, 0.1f, 0.5f, 0.1f)));
    CHECK(std::isnan(gaussianVisibility(phi, 0.5f, 0.0f, nan, 0.1f)));
}
