#include "core/base/elementary.h"

#include "catch.h"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <cmath>
#include <random>

using namespace lrsm;
using Big = boost::multiprecision::cpp_bin_float_50;

TEST_CASE("sinCos, log2Exact, exp2Exact hold their bounds against 50-digit arithmetic", "[core][elementary]")
{
    std::mt19937_64 random(1);
    double worstSin = 0, worstLog = 0, worstExp = 0;
    for (int i = 0; i < 20000; ++i) {
        const double scale = std::ldexp(1.0, static_cast<int>(random() % 30) - 10);
        const double angle = std::uniform_real_distribution<>(-scale, scale)(random);
        const SinCos sc = sinCos(angle);
        worstSin =
            std::max({worstSin, std::abs(static_cast<double>(Big(sc.sin) - sin(Big(angle)))), std::abs(static_cast<double>(Big(sc.cos) - cos(Big(angle))))});

        const double x = std::ldexp(std::uniform_real_distribution<>(0.5, 1.0)(random), static_cast<int>(random() % 200) - 100);
        const Big exactLog = log(Big(x)) / log(Big(2));
        worstLog = std::max(worstLog, std::abs(static_cast<double>(Big(log2Exact(x)) - exactLog)) / std::max(1.0, std::abs(static_cast<double>(exactLog))));

        const double y = std::uniform_real_distribution<>(-900.0, 900.0)(random);
        const Big exactExp = pow(Big(2), Big(y));
        worstExp = std::max(worstExp, std::abs(static_cast<double>((Big(exp2Exact(y)) - exactExp) / exactExp)));
    }
    CAPTURE(worstSin, worstLog, worstExp);
    CHECK(worstSin <= kSinCosMaxError);
    CHECK(worstLog <= kLog2MaxError);
    CHECK(worstExp <= kExp2MaxError);
}

TEST_CASE("fastLog2 holds its bound everywhere and is exact at powers of two", "[core][elementary]")
{
    double worst = 0;
    float worstAt = 0;
    for (float x = 1e-6f; x < 1e6f; x = std::nextafter(x * 1.00001f, 1e9f)) {
        const double exact = std::log2(static_cast<double>(x));
        const double error = std::abs(static_cast<double>(fastLog2(x)) - exact) - std::abs(exact) * 0x1p-24;
        if (error > worst) worst = error, worstAt = x;
    }
    CAPTURE(worst, worstAt);
    CHECK(worst <= static_cast<double>(kFastLog2MaxError));
    for (int e = -100; e <= 100; ++e) CHECK(fastLog2(std::ldexp(1.0f, e)) == static_cast<float>(e));
}

TEST_CASE("fastExp2 holds its bound and is exact at whole numbers", "[core][elementary]")
{
    double worst = 0;
    for (float x = -126.0f; x < 127.99f; x += 0.00173f) worst = std::max(worst, std::abs(double(fastExp2(x)) / std::exp2(double(x)) - 1));
    CAPTURE(worst);
    CHECK(worst <= double(kFastExp2MaxError));
    for (int e = -126; e <= 127; ++e) CHECK(fastExp2(float(e)) == std::ldexp(1.0f, e));
    CHECK(fastExp2(-200.0f) == 0.0f);
    CHECK(fastExp2(-std::numeric_limits<float>::infinity()) == 0.0f);
    CHECK(std::isinf(fastExp2(129.0f)));
    CHECK(std::isnan(fastExp2(std::nanf(""))));
}

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
}

TEST_CASE("arcTangent2 holds its bound in every quadrant and is exact on the axes", "[core][elementary]")
{
    std::mt19937_64 random(5);
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        const double scale = std::ldexp(1.0, static_cast<int>(random() % 60) - 30);
        const double x = std::uniform_real_distribution<>(-scale, scale)(random), y = std::uniform_real_distribution<>(-1.0, 1.0)(random);
        worst = std::max(worst, std::abs(static_cast<double>(Big(arcTangent2(y, x)) - atan2(Big(y), Big(x)))));
    }
    CAPTURE(worst);
    CHECK(worst <= kArcTangentMaxError);
    const double pi = 3.14159265358979323846;
    CHECK(arcTangent2(0.0, 1.0) == 0.0);
    CHECK(arcTangent2(1.0, 0.0) == pi / 2);
    CHECK(arcTangent2(-1.0, 0.0) == -pi / 2);
    CHECK(arcTangent2(0.0, -1.0) == pi);
    CHECK(arcTangent2(0.0, 0.0) == 0.0);
    CHECK(std::abs(arcTangent2(1.0, 1.0) - pi / 4) <= kArcTangentMaxError);
    CHECK(std::isnan(arcTangent2(std::nan(""), 1.0)));
}
