#pragma once

#include "core/base/simd.h"
#include "core/settings/settings.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lrsm {

/// Variance floor in warped units (depth in [0, 1] of the layer): what UNORM16 moments can resolve.
inline constexpr float kVarianceFloor = 2.5e-5f;
inline constexpr double kVarianceFloorSlack = 1.15;  ///< it is at most this much above the largest variance that rounding leaves of a flat texel

/// Bounds on the absolute error of Phi, tested against 50-digit arithmetic. `table` has two parts: the interpolation error h^2/8 max|Phi''|
/// for N entries over [-5, 5], which tableCdfMaxError() adds to the constant part (the tails cut at +-5, Phi(-5) = 2.9e-7, and float rounding).
inline constexpr float kPolynomialCdfMaxError = 3e-7f;
inline constexpr float kExactCdfMaxError = 3.1e-8f;  ///< the final rounding to float
inline constexpr double kExactDoubleCdfMaxError = 1e-15;
inline constexpr double kExactDoubleCdfMaxRelativeError = 2e-13;  ///< in the lower tail, down to x = -37
inline constexpr float kTableCdfRoundingError = 5e-7f;
inline constexpr float kTableHalfWidth = 5.0f;
float tableCdfMaxError(int tableSize);

/// Phi in double by our own series and continued fraction: the accurate twin of the kernels' versions.
/// Absolute error <= kExactDoubleCdfMaxError; in the lower tail also relative, <= kExactDoubleCdfMaxRelativeError
/// down to x = -37. NaN gives NaN.
double normalCdfExact(double x);

/// Phi(x) - 1/2, lane by lane: an odd rational function x P(x^2) / Q(x^2), degrees 5 and 4, minimax on |x| <= 5.25 and constant beyond.
/// |error| <= kPolynomialCdfMaxError. Odd exactly; NaN lanes are unspecified but finite or NaN.
/// The coefficients, lowest power first, are our own fit: Lawson-weighted rational least squares in 34 digits (error 9.5e-8), then a search over
/// neighbouring floats for the least error with this very order of operations (2.0e-7, which is rounding).
inline constexpr float kCdfNumerator[6] = {0.398941666f, 0.0627202615f, 0.00624953536f, 0.000437803013f, 5.68767609e-06f, -1.68606515e-08f};
inline constexpr float kCdfDenominator[5] = {1.0f, 0.323872954f, 0.0446628183f, 0.00340477377f, 0.000147190076f};
inline constexpr float kCdfLimit = 5.25f;
inline Float4 centredCdfPolynomial(Float4 x)
{
    constexpr float p0 = kCdfNumerator[0], p1 = kCdfNumerator[1], p2 = kCdfNumerator[2], p3 = kCdfNumerator[3], p4 = kCdfNumerator[4], p5 = kCdfNumerator[5];
    constexpr float q1 = kCdfDenominator[1], q2 = kCdfDenominator[2], q3 = kCdfDenominator[3], q4 = kCdfDenominator[4];
    const Float4 limit = splat(kCdfLimit), half = splat(0.5f);
    x = x > limit ? limit : x;
    x = x < -limit ? -limit : x;
    const Float4 t = x * x;
    const Float4 p = ((((p5 * t + p4) * t + p3) * t + p2) * t + p1) * t + p0;
    const Float4 q = (((q4 * t + q3) * t + q2) * t + q1) * t + 1.0f;
    const Float4 y = x * p / q;
    const Float4 capped = y > half ? half : y;
    return capped < -half ? -half : capped;
}

/// Standard normal distribution function Phi, three ways; the trade of speed for accuracy is a setting.
/// `table`: linear interpolation in N entries over [-5, 5]; `polynomial`: our own, the default; `exact`: double, our own erfc.
class NormalCdf {
  public:
    /// `tableSize` is used by `table` alone; 2..65536, clamped.
    explicit NormalCdf(GaussianMethod method = GaussianMethod::polynomial, int tableSize = 1024);

    float operator()(float x) const
    {
        if (x != x) return x;
        switch (method_) {
        case GaussianMethod::table: return lookUp(x);
        case GaussianMethod::polynomial: return 0.5f + centredCdfPolynomial(splat(x))[0];
        default: return static_cast<float>(normalCdfExact(x));
        }
    }
    /// Stated bound on |error| of this instance, against exact arithmetic, for any float x; NaN gives NaN.
    float maxError() const;
    GaussianMethod method() const { return method_; }
    const std::vector<float>& table() const { return table_; }  ///< empty unless `table`

  private:
    float lookUp(float x) const
    {
        if (!(x > -kTableHalfWidth)) return 0.0f;
        if (!(x < kTableHalfWidth)) return 1.0f;
        const float position = (x + kTableHalfWidth) * scale_;
        const int cell = std::min(static_cast<int>(position), static_cast<int>(table_.size()) - 2);
        const float* entry = table_.data() + cell;
        return entry[0] + (position - static_cast<float>(cell)) * (entry[1] - entry[0]);
    }

    GaussianMethod method_;
    std::vector<float> table_;
    float scale_ = 0.0f;  ///< entries per unit of x
};

/// What gaussianVisibility's float arithmetic adds to the error of the two Phi it subtracts.
inline constexpr float kGaussianArgumentError = 2.5e-7f;
/// Bound on |error| of gaussianVisibility for the inputs as given.
inline float gaussianVisibilityMaxError(const NormalCdf& phi)
{
    return 2.0f * phi.maxError() + kGaussianArgumentError;
}

/// The same in double throughout, by normalCdfExact: what `exact` evaluates before its final rounding.
double gaussianVisibilityExact(double mu, double sigma2, double zc, double rc);

/// Eq. 12: the fraction of the footprint whose depth lies in [zc - rc, zc + rc], depths taken as N(mu, sigma2).
/// All in the same unit, finite, rc >= 0. sigma2 <= 0 is the flat texel: 1 inside, 0 outside, 1/2 on the edge. NaN gives NaN.
inline float gaussianVisibility(const NormalCdf& phi, float mu, float sigma2, float zc, float rc)
{
    if (phi.method() == GaussianMethod::exact) return static_cast<float>(gaussianVisibilityExact(mu, sigma2, zc, rc));

    // Distance of the centre from the mean, and what rounding took from it [Knuth's two-sum]: where rc and d nearly cancel,
    // that lost part over a small sigma would be the largest error of all.
    const float d = zc - mu;
    const float zcSeen = d + mu;
    const float lost = (zc - zcSeen) - (mu - (zcSeen - d));
    const float distance = std::abs(d), lostOutwards = d < 0.0f ? -lost : lost;
    const float inner = (rc - distance) - lostOutwards;

    if (!(sigma2 > 0.0f)) return inner > 0.0f ? 1.0f : inner < 0.0f ? 0.0f : inner == 0.0f ? 0.5f : inner;
    const float sigma = std::sqrt(sigma2), outer = rc + distance;

    // By symmetry of the normal distribution about mu; the two halves of 1/2 +- cancel without rounding.
    if (phi.method() == GaussianMethod::polynomial) {
        const Float4 y = centredCdfPolynomial(Float4{inner, outer, 0.0f, 0.0f} / sigma);
        return std::clamp(y[0] + y[1], 0.0f, 1.0f);
    }
    return std::clamp(phi(inner / sigma) - phi(-outer / sigma), 0.0f, 1.0f);
}

}  // namespace lrsm
