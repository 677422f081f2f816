#include "apps/bench/power_fit.h"
#include "catch.h"

#include <cmath>
#include <vector>

using namespace lrsm;

namespace {

constexpr int kTrials = 40;

/// Relative noise in [-size, size], another for each index and trial.
double noisy(double value, double size, int trial, int index)
{
    const double u = std::fmod(std::sin(12.9898 * (trial + 1) + 78.233 * (index + 1)) * 43758.5453, 1.0);
    return value * (1.0 + size * u);
}

std::vector<double> doublings(double first, int count)
{
    std::vector<double> x;
    for (int i = 0; i < count; ++i) x.push_back(std::ldexp(first, i));
    return x;
}

template <class Law>
std::vector<double> sampled(const std::vector<double>& x, Law law)
{
    std::vector<double> t;
    for (const double value : x) t.push_back(law(value));
    return t;
}

}  // namespace

TEST_CASE("power fit: a pure power law is found exactly", "[sweep][scaling]")
{
    for (const double exponent : {-1.0, 0.0, 0.5, 1.0, 1.5, 3.0}) {
        const std::vector<double> x = doublings(3.0, 6), t = sampled(x, [&](double v) { return 0.07 * std::pow(v, exponent); });
        const auto fit = fitPower(x, t);
        REQUIRE(fit);
        CHECK(fit->exponent == Approx(exponent).margin(1e-12));
        CHECK(fit->coefficient == Approx(0.07).epsilon(1e-10));
        CHECK(fit->standardError < 1e-7);
        CHECK(fit->r2 == Approx(1.0));
        CHECK(fit->at(5.0) == Approx(0.07 * std::pow(5.0, exponent)));
    }
}

TEST_CASE("power fit: the standard error says how far noise moves the exponent", "[sweep][scaling]")
{
    // With noise of 10 %, the true exponent lies within three standard errors nearly always (t distribution, four degrees of freedom: 96 %),
    // and outside of half of one often: the error is neither too small nor too large.
    const std::vector<double> x = doublings(1.0, 6);
    int within = 0, outside = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        std::vector<double> t;
        for (std::size_t i = 0; i < x.size(); ++i) t.push_back(noisy(5.0 * std::pow(x[i], 1.5), 0.1, trial, int(i)));
        const auto fit = fitPower(x, t);
        REQUIRE(fit);
        const double off = std::abs(fit->exponent - 1.5);
        CHECK(off < 0.08);
        within += off < 3.0 * fit->standardError;
        outside += off > 0.5 * fit->standardError;
    }
    CHECK(within >= kTrials * 8 / 10);
    CHECK(outside >= kTrials * 3 / 10);
}

TEST_CASE("power fit: the error and r2 are those of the textbook", "[sweep][scaling]")
{
    // log2 t = 0, 1, 1, 3 over log2 x = 0, 1, 2, 3: slope 0.9, intercept -0.1; squares left 0.7 of 4.75; error sqrt(0.7 / 2 / 5).
    const auto fit = fitPower(std::vector<double>{1, 2, 4, 8}, std::vector<double>{1, 2, 2, 8});
    REQUIRE(fit);
    CHECK(fit->exponent == Approx(0.9));
    CHECK(fit->coefficient == Approx(std::exp2(-0.1)));
    CHECK(fit->standardError == Approx(std::sqrt(0.07)));
    CHECK(fit->r2 == Approx(1.0 - 0.7 / 4.75));
}

TEST_CASE("power fit: what has no logarithm or no second size has no exponent", "[sweep][scaling]")
{
    const std::vector<double> x = {1, 2, 4, 8, 16};
    CHECK_FALSE(fitPower(x, std::vector<double>{1, 2, 0, 4, 5}));
    CHECK_FALSE(fitPower(x, std::vector<double>{1, 2, std::nan(""), 4, 5}));
    CHECK_FALSE(fitPower(x, std::vector<double>{1, 2}));
    CHECK_FALSE(fitPower(std::vector<double>{2, 2, 2}, std::vector<double>{1, 2, 3}));
    CHECK_FALSE(fitPower(std::vector<double>{}, std::vector<double>{}));
    CHECK_FALSE(fitOffsetPower(std::vector<double>{1, 2, 4}, std::vector<double>{1, 2, 3}));  // three unknowns
    CHECK_FALSE(fitOffsetPower(x, std::vector<double>{1, 2, -3, 4, 5}));
}

TEST_CASE("offset fit: what grows is told from what does not", "[sweep][scaling]")
{
    const std::vector<double> x = doublings(64.0, 6);
    for (const double constant : {0.0, 2.0, 400.0})
        for (const double exponent : {-1.0, 0.5, 1.0, 2.0, 3.0}) {
            const std::vector<double> t = sampled(x, [&](double v) { return constant + 3.0 * std::pow(v / 512.0, exponent); });
            const auto fit = fitOffsetPower(x, t);
            REQUIRE(fit);
            INFO("constant " << constant << ", exponent " << exponent);
            CHECK(fit->exponent == Approx(exponent).margin(2e-3));
            CHECK(fit->constant == Approx(constant).epsilon(2e-3).margin(1e-2));
            CHECK(fit->residual < 1e-4);
            for (std::size_t i = 0; i < x.size(); ++i) CHECK(fit->at(x[i]) == Approx(t[i]).epsilon(1e-3));
        }
    // The plain power law is misled by the constant: that is what the other fit is for.
    const std::vector<double> t = sampled(x, [](double v) { return 1e5 + v * v; });
    CHECK(fitPower(x, t)->exponent < 1.5);
    CHECK(fitOffsetPower(x, t)->exponent == Approx(2.0).margin(2e-3));
    CHECK(fitOffsetPower(x, t)->constantShare(64.0) == Approx(1e5 / (1e5 + 64.0 * 64.0)).epsilon(1e-3));
}

TEST_CASE("offset fit: noise of 5 % moves the exponent little", "[sweep][scaling]")
{
    const std::vector<double> x = doublings(64.0, 7);
    for (int trial = 0; trial < kTrials; ++trial) {
        std::vector<double> t;
        for (std::size_t i = 0; i < x.size(); ++i) t.push_back(noisy(20.0 + 1e-3 * x[i] * x[i], 0.05, trial, int(i)));
        CHECK(fitOffsetPower(x, t)->exponent == Approx(2.0).margin(0.15));
        CHECK(fitOffsetPower(x, t)->constant == Approx(20.0).margin(4.0));
    }
}

TEST_CASE("offset fit: what does not change is a constant, and nothing is below 0", "[sweep][scaling]")
{
    const std::vector<double> x = doublings(1.0, 5);
    const auto flat = fitOffsetPower(x, std::vector<double>(5, 7.0));
    REQUIRE(flat);
    for (const double value : x) CHECK(flat->at(value) == Approx(7.0));
    // Faster than the power allowed at its small end: the constant wants to be negative.
    const auto bent = fitOffsetPower(x, sampled(x, [](double v) { return v * v - 0.9; }));
    REQUIRE(bent);
    CHECK(bent->constant >= 0.0);
    CHECK(bent->factor >= 0.0);
}
