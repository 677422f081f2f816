#include "core/base/elementary.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lrsm {
namespace {

constexpr int kSeriesTerms = 10;

/// Coefficients (-1)^n / (2n + parity)! of sin (parity 1) or cos (parity 0), highest power first.
constexpr std::array<double, kSeriesTerms> trigonometricSeries(int parity)
{
    std::array<double, kSeriesTerms> series{};
    double factorial = 1.0;
    for (int n = 0; n < kSeriesTerms; ++n) {
        if (n > 0) factorial *= double((2 * n + parity - 1) * (2 * n + parity));
        series[std::size_t(kSeriesTerms - 1 - n)] = (n % 2 ? -1.0 : 1.0) / factorial;
    }
    return series;
}
constexpr auto kSinSeries = trigonometricSeries(1), kCosSeries = trigonometricSeries(0);

}  // namespace

SinCos sinCos(double angleRadians)
{
    // Cody-Waite reduction: pi/2 split in three parts, the first two with trailing zeros so that k * part is exact.
    constexpr double kHalfPi1 = 0x1.921fb544p+0, kHalfPi2 = 0x1.0b4611a6p-34, kHalfPi3 = 0x1.3198a2e037073p-69;
    if (!(std::abs(angleRadians) <= 1e6)) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        return {nan, nan};
    }
    const double k = std::floor(angleRadians * 0.63661977236758134308 + 0.5);
    const double r = ((angleRadians - k * kHalfPi1) - k * kHalfPi2) - k * kHalfPi3;

    // Taylor series about 0; on |r| <= pi/4 the first omitted terms are below 1e-18.
    const double r2 = r * r;
    double s = kSinSeries[0], c = kCosSeries[0];
    for (int n = 1; n < kSeriesTerms; ++n) {
        s = s * r2 + kSinSeries[n];
        c = c * r2 + kCosSeries[n];
    }
    s *= r;

    switch (static_cast<std::int64_t>(k) & 3) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
    }
}

double tangent(double angleRadians)
{
    const SinCos sc = sinCos(angleRadians);
    return sc.sin / sc.cos;
}

double arcTangent2(double y, double x)
{
    if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
    const double ax = std::abs(x), ay = std::abs(y), larger = std::max(ax, ay);
    if (larger == 0.0) return 0.0;
    double t = std::min(ax, ay) / larger;  // in [0, 1]; infinities give NaN here
    if (std::isnan(t)) t = 1.0;

    // Two half-angle steps, atan t = 2 atan(t / (1 + sqrt(1 + t^2))), leave t <= tan(pi/16) = 0.1989; then the series,
    // whose first omitted term is below 1e-18.
    for (int i = 0; i < 2; ++i) t = t / (1.0 + std::sqrt(1.0 + t * t));
    const double t2 = t * t;
    double series = 0.0;
    for (int n = 23; n >= 1; n -= 2) series = 1.0 / double(n) - series * t2;
    double angle = 4.0 * t * series;

    if (ay > ax) angle = 1.57079632679489661923 - angle;
    if (x < 0.0) angle = 3.14159265358979323846 - angle;
    return std::copysign(angle, y);
}

double log2Exact(double x)
{
    if (!(x > 0.0)) return x == 0.0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    int exponent = 0;
    double mantissa = std::frexp(x, &exponent);  // exact
    if (mantissa < 0.70710678118654752440) {
        mantissa *= 2.0;
        --exponent;
    }
    // log2 m = (2 / ln 2) artanh((m - 1) / (m + 1)); |s| <= 0.1716, so s^25 / 25 < 1e-20.
    const double s = (mantissa - 1.0) / (mantissa + 1.0), s2 = s * s;
    double series = 0.0;
    for (int n = 23; n >= 1; n -= 2) series = series * s2 + 1.0 / double(n);
    return double(exponent) + 2.8853900817779268147 * s * series;
}

double exp2Exact(double x)
{
    if (std::isnan(x)) return x;
    if (x > 1100.0) return std::numeric_limits<double>::infinity();
    if (x < -1200.0) return 0.0;
    const double whole = std::floor(x + 0.5);
    const double t = (x - whole) * 0.69314718055994530942;  // |t| <= 0.3466
    double series = 1.0;
    for (int n = 15; n >= 1; --n) series = 1.0 + series * t / double(n);
    return std::ldexp(series, static_cast<int>(whole));
}

double power(double x, double y)
{
    if (y == 0.0) return 1.0;
    if (x == 0.0) return y > 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
    return exp2Exact(y * log2Exact(x));
}

}  // namespace lrsm
