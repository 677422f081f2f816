#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

/// Elementary functions that give the same bits on every IEEE-754 machine and with every compiler: only
/// + - * / and sqrt, evaluated in double in a fixed order. The C library's own differ between versions and
/// between compile time and run time, which would break golden hashes.
///
/// Each bound is absolute unless stated, measured against 100-digit arithmetic by test_elementary.
namespace lrsm {

struct SinCos {
    double sin, cos;
};

/// sin and cos of an angle in radians, |angle| <= 1e6; error <= kSinCosMaxError. NaN in, NaN out.
SinCos sinCos(double angleRadians);
double tangent(double angleRadians);
inline constexpr double kSinCosMaxError = 4e-16;

/// Angle of the point (x, y) from the x axis, in [-pi, pi]; error <= kArcTangentMaxError. (0, 0) gives 0; NaN in, NaN out.
double arcTangent2(double y, double x);
inline constexpr double kArcTangentMaxError = 1e-15;

/// Base-2 logarithm of x > 0 (normal double); error <= kLog2MaxError * max(1, |log2 x|).
/// 0 gives -infinity, a negative argument or NaN gives NaN.
double log2Exact(double x);
inline constexpr double kLog2MaxError = 4e-16;

/// 2^x for |x| <= 1000; relative error <= kExp2MaxError. Saturates to 0 and infinity beyond.
double exp2Exact(double x);
inline constexpr double kExp2MaxError = 4e-16;

/// x^y for x >= 0 by way of the two above (0^y = 0 for y > 0; x^0 = 1). Relative error <= kPowerMaxError for |y log2 x| <= 100.
double power(double x, double y);
inline constexpr double kPowerMaxError = 2.5e-14;

/// Fast base-2 logarithm for kernels: x > 0 normal float; error <= kFastLog2MaxError + |log2 x| 2^-24, the second part being the result's own
/// rounding. Exact for powers of two.
inline constexpr float kFastLog2MaxError = 2e-7f;
inline float fastLog2(float x)
{
    // Exponent by integer arithmetic; the mantissa in [sqrt(1/2), sqrt 2) through the same artanh series, cut at s^7
    // (first omitted term 2/ln2 s^9 / 9 < 5e-8).
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) - 0x3f3504f3u;
    const auto exponent = static_cast<std::int32_t>(bits) >> 23;
    const float m = std::bit_cast<float>((bits & 0x007fffffu) + 0x3f3504f3u);
    const float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
    const float series = ((0.41219858f * s2 + 0.57707802f) * s2 + 0.96179669f) * s2 + 2.8853901f;
    return static_cast<float>(exponent) + s * series;
}

/// Fast 2^x for kernels: relative error <= kFastExp2MaxError for -126 <= x <= 127; 0 below (also for -infinity), infinity above.
inline constexpr float kFastExp2MaxError = 4e-7f;
inline float fastExp2(float x)
{
    if (!(x >= -126.0f)) return x < -126.0f ? 0.0f : x;  // NaN stays
    if (x >= 128.0f) return std::numeric_limits<float>::infinity();
    const float whole = std::floor(x + 0.5f);
    const float t = (x - whole) * 0.69314718f;  // |t| <= 0.3466: Taylor to t^6, omitted t^7 / 5040 < 2e-7
    const float series = 1.0f + t * (1.0f + t * (0.5f + t * (0.16666667f + t * (0.041666667f + t * (0.0083333333f + t * 0.0013888889f)))));
    const auto exponent = static_cast<std::int32_t>(whole);  // 128 only for x in [127.5, 128): split so that it stays in range
    return series * std::bit_cast<float>((exponent > 127 ? 254 : exponent + 127) << 23) * (exponent > 127 ? 2.0f : 1.0f);
}

}  // namespace lrsm
