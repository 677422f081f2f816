#pragma once

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
inline constexpr double kExp2MaxError = 1e-15;

/// x^y for x >= 0 by way of the two above (0^y = 0 for y > 0; x^0 = 1). Relative error <= 1e-13 for |y log2 x| <= 100.
double power(double x, double y);

/// Fast base-2 logarithm for kernels: x > 0 normal float; error <= kFastLog2MaxError. Exact for powers of two.
float fastLog2(float x);
inline constexpr float kFastLog2MaxError = 2e-6f;

}  // namespace lrsm
