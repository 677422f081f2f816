// [1] Sugihara, Rauwendaal, Salvi: Layered Reflective Shadow Maps for Voxel-based Indirect Illumination, HPG 2014, Eq. 12.
// [2] Abramowitz, Stegun: Handbook of Mathematical Functions, 26.2.11 (series) and 26.2.14 (continued fraction).
#include "lrsm/gaussian_visibility.h"

#include "core/base/elementary.h"

namespace lrsm {
namespace {

constexpr double kLog2E = 1.4426950408889634074, kInverseSqrt2Pi = 0.39894228040143267794;

double normalDensity(double x)
{
    return kInverseSqrt2Pi * exp2Exact(-0.5 * x * x * kLog2E);
}

}  // namespace

double normalCdfExact(double x)
{
    const double a = std::abs(x);
    if (a < 2.5) {
        // Phi - 1/2 = phi(x) (x + x^3/3 + x^5/(3 5) + ...) [2]: all terms of one sign, so nothing cancels.
        double term = a, sum = a;
        for (int n = 1; n <= 40; ++n) {
            term *= a * a / static_cast<double>(2 * n + 1);
            sum += term;
        }
        const double centred = normalDensity(a) * sum;
        return x < 0.0 ? 0.5 - centred : 0.5 + centred;
    }
    if (!(a < 40.0)) return x != x ? x : x < 0.0 ? 0.0 : 1.0;
    // The tail Q = phi(x) / (x + 1/(x + 2/(x + 3/(x + ...)))) [2], from the inside out.
    double fraction = a;
    for (int n = 90; n >= 1; --n) fraction = a + static_cast<double>(n) / fraction;
    const double tail = normalDensity(a) / fraction;
    return x < 0.0 ? tail : 1.0 - tail;
}

double gaussianVisibilityExact(double mu, double sigma2, double zc, double rc)
{
    const double distance = std::abs(zc - mu), inner = rc - distance;
    if (!(sigma2 > 0.0)) return inner > 0.0 ? 1.0 : inner < 0.0 ? 0.0 : inner == 0.0 ? 0.5 : inner;
    const double sigma = std::sqrt(sigma2);
    // The tail farther out is always a lower one; the nearer is too when the centre is outside, which keeps relative accuracy.
    return std::clamp(normalCdfExact(inner / sigma) - normalCdfExact(-(rc + distance) / sigma), 0.0, 1.0);
}

NormalCdf::NormalCdf(GaussianMethod method, int tableSize) : method_(method)
{
    if (method != GaussianMethod::table) return;
    const int entries = std::clamp(tableSize, 2, 65536);
    table_.resize(static_cast<std::size_t>(entries));
    const double width = 2.0 * kTableHalfWidth;
    for (int i = 0; i < entries; ++i)
        table_[static_cast<std::size_t>(i)] =
            static_cast<float>(normalCdfExact(width * static_cast<double>(i) / static_cast<double>(entries - 1) - kTableHalfWidth));
    scale_ = static_cast<float>(static_cast<double>(entries - 1) / width);
}

float tableCdfMaxError(int tableSize)
{
    constexpr double kLargestCurvature = 0.24197072451914337;  // |Phi''| = |x| phi(x), at x = +-1
    const double h = 2.0 * kTableHalfWidth / static_cast<double>(std::clamp(tableSize, 2, 65536) - 1);
    return std::min(1.0f, static_cast<float>(h * h / 8.0 * kLargestCurvature) + kTableCdfRoundingError);
}

float NormalCdf::maxError() const
{
    switch (method_) {
    case GaussianMethod::table: return tableCdfMaxError(static_cast<int>(table_.size()));
    case GaussianMethod::polynomial: return kPolynomialCdfMaxError;
    default: return kExactCdfMaxError;
    }
}

}  // namespace lrsm
