#include "lrsm/gaussian_visibility.h"
#include "synthetic_rsm.h"

#include <catch.h>
#include <boost/math/special_functions/erf.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>

using namespace lrsm;
using Wide = boost::multiprecision::cpp_bin_float_50;

namespace {

/// Phi to 50 digits, by the lower tail so that nothing cancels there.
Wide oraclePhi(const Wide& x)
{
    return boost::math::erfc(Wide(-x / sqrt(Wide(2)))) / 2;
}

Wide oracleVisibility(float mu, float sigma2, float zc, float rc)
{
    const Wide sigma = sqrt(Wide(sigma2)), d = abs(Wide(zc) - Wide(mu));
    return oraclePhi((Wide(rc) - d) / sigma) - oraclePhi((-Wide(rc) - d) / sigma);
}

/// Random floats of every magnitude that matters to Phi, of either sign.
float anyArgument(std::mt19937& random)
{
    const float spread = test::uniform(random) < 0.7f ? 6.5f : 40.0f;
    float x = test::uniform(random, -spread, spread);
    if (test::uniform(random) < 0.2f) x *= std::ldexp(1.0f, -static_cast<int>(random() % 40));
    return x;
}

double worstError(const NormalCdf& phi, int samples, unsigned seed)
{
    std::mt19937 random(seed);
    double worst = 0.0;
    for (int i = 0; i < samples; ++i) {
        const float x = anyArgument(random);
        worst = std::max(worst, static_cast<double>(abs(Wide(phi(x)) - oraclePhi(x))));
    }
    return worst;
}

}  // namespace

TEST_CASE("Phi keeps its stated error by each method", "[lrsm][eq12]")
{
    const int samples = 3000;
    SECTION("polynomial")
    {
        CHECK(worstError(NormalCdf(GaussianMethod::polynomial), samples, 1) <= NormalCdf(GaussianMethod::polynomial).maxError());
    }
    SECTION("exact")
    {
        CHECK(worstError(NormalCdf(GaussianMethod::exact), samples, 2) <= NormalCdf(GaussianMethod::exact).maxError());
    }
    SECTION("table")
    {
        const int entries = GENERATE(2, 3, 16, 64, 256, 1024, 4096, 65536);
        const NormalCdf phi(GaussianMethod::table, entries);
        CAPTURE(entries);
        CHECK(phi.maxError() == tableCdfMaxError(entries));
        const double worst = worstError(phi, samples, 3);
        CHECK(worst <= phi.maxError());
        if (entries >= 16 && entries <= 256) CHECK(worst >= 0.5 * phi.maxError());  // the bound is no idle one
    }
}

TEST_CASE("a table is right at its own entries, the last cell included", "[lrsm][eq12]")
{
    const NormalCdf phi(GaussianMethod::table, 11);  // entries at -5, -4, ... 5
    for (const float x : {std::nextafter(-5.0f, 0.0f), -4.0f, -3.0f, -1.0f, 0.0f, 2.0f, 4.0f, std::nextafter(5.0f, 0.0f)})
        CHECK(std::abs(static_cast<double>(phi(x)) - normalCdfExact(x)) <= static_cast<double>(kTableCdfRoundingError));
}

TEST_CASE("the exact Phi is good to double precision, and relative in the lower tail", "[lrsm][eq12]")
{
    std::mt19937 random(4);
    double worst = 0.0, worstRelative = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const double x = anyArgument(random);
        const Wide error = abs(Wide(normalCdfExact(x)) - oraclePhi(x));
        worst = std::max(worst, static_cast<double>(error));
        if (x < 0.0 && x > -37.0) worstRelative = std::max(worstRelative, static_cast<double>(error / oraclePhi(x)));
    }
    CHECK(worst <= kExactDoubleCdfMaxError);
    CHECK(worstRelative <= kExactDoubleCdfMaxRelativeError);
    // Either side of the change from series to continued fraction.
    CHECK(std::abs(normalCdfExact(2.5) - normalCdfExact(std::nextafter(2.5, 0.0))) < 1e-15);
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

TEST_CASE("the visible fraction keeps its stated error, tiny sigma included", "[lrsm][eq12]")
{
    const auto method = GENERATE(GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact);
    const NormalCdf phi(method, 1024);
    const double bound = method == GaussianMethod::exact ? static_cast<double>(kExactCdfMaxError) : static_cast<double>(gaussianVisibilityMaxError(phi));
    std::mt19937 random(5);
    for (int i = 0; i < 3000; ++i) {
        // mu of few and of many trailing bits, so that zc - mu is not always exact.
        const float mu = std::ldexp(test::uniform(random), -static_cast<int>(random() % 8)),
                    sigma = std::ldexp(test::uniform(random, 0.5f, 1.0f), -static_cast<int>(random() % 24));
        const float rc = std::ldexp(test::uniform(random, 0.5f, 1.0f), -static_cast<int>(random() % 16));
        // Half of the samples put an end of the window within a few sigma of the mean, where V changes.
        const float zc = (i & 1) ? test::uniform(random, -0.5f, 1.5f) : mu + rc + sigma * test::uniform(random, -4.0f, 4.0f);
        const float v = gaussianVisibility(phi, mu, sigma * sigma, zc, rc);
        CAPTURE(mu, sigma, zc, rc, v);
        REQUIRE(v >= 0.0f);
        REQUIRE(v <= 1.0f);
        REQUIRE(static_cast<double>(abs(Wide(v) - oracleVisibility(mu, sigma * sigma, zc, rc))) <= bound);
    }
}

TEST_CASE("the visible fraction is symmetric about the mean and grows with the radius", "[lrsm][eq12]")
{
    const auto method = GENERATE(GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact);
    const NormalCdf phi(method, 512);
    std::mt19937 random(6);
    for (int i = 0; i < 500; ++i) {
        const float d = std::floor(test::uniform(random) * 1024.0f) / 1024.0f, sigma2 = test::uniform(random, 1e-5f, 0.2f);
        float before = 0.0f;
        for (float rc = 0.0f; rc < 2.0f; rc += 0.03125f) {
            const float v = gaussianVisibility(phi, 0.5f, sigma2, 0.5f + d, rc);
            REQUIRE(v == gaussianVisibility(phi, 0.5f, sigma2, 0.5f - d, rc));
            REQUIRE(v >= before - 2.0f * phi.maxError());
            before = v;
        }
    }
}

TEST_CASE("windows side by side tile the distribution: fractions sum to 1", "[lrsm][eq12]")
{
    const auto method = GENERATE(GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact);
    const NormalCdf phi(method, 1024);
    double sum = 0.0;
    const int windows = 64;
    for (int i = 0; i < windows; ++i)
        sum += static_cast<double>(gaussianVisibility(phi, 0.4f, 0.01f, (static_cast<float>(i) + 0.5f) / 32.0f - 0.5f, 1.0f / 64.0f));
    CHECK(std::abs(sum - 1.0) <= windows * static_cast<double>(gaussianVisibilityMaxError(phi)));
    CHECK(std::abs(sum - 1.0) <= 4e-6);
}

TEST_CASE("zero or negative variance is a step with 1/2 on the edge", "[lrsm][eq12]")
{
    const auto method = GENERATE(GaussianMethod::table, GaussianMethod::polynomial, GaussianMethod::exact);
    const NormalCdf phi(method);
    for (const float sigma2 : {0.0f, -0.0f, -1e-3f}) {
        CHECK(gaussianVisibility(phi, 0.5f, sigma2, 0.25f, 0.25f) == 0.5f);
        CHECK(gaussianVisibility(phi, 0.5f, sigma2, 0.75f, 0.25f) == 0.5f);
        CHECK(gaussianVisibility(phi, 0.5f, sigma2, 0.25f, std::nextafter(0.25f, 1.0f)) == 1.0f);
        CHECK(gaussianVisibility(phi, 0.5f, sigma2, 0.25f, std::nextafter(0.25f, 0.0f)) == 0.0f);
    }
    // The smallest variances that are not 0 approach the same step.
    const float tiny = std::numeric_limits<float>::denorm_min();
    CHECK(gaussianVisibility(phi, 0.5f, tiny, 0.25f, 0.25f) == Approx(0.5f));
    CHECK(gaussianVisibility(phi, 0.5f, tiny, 0.5f, 1e-3f) == Approx(1.0f));
    CHECK(gaussianVisibility(phi, 0.5f, tiny, 0.25f, 0.1f) == 0.0f);
    CHECK(std::isnan(gaussianVisibility(phi, std::numeric_limits<float>::quiet_NaN(), 0.1f, 0.5f, 0.1f)));
    CHECK(std::isnan(gaussianVisibility(phi, 0.5f, 0.0f, std::numeric_limits<float>::quiet_NaN(), 0.1f)));
}
