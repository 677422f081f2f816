#include "conetrace/proxies/vpl.h"

#include "core/scene/brdf.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace {

constexpr double kRootTwoPi = 2.50662827463100050242, kExponentOfTwo = 1.44269504088896340736, kHemisphere = 6.28318530717958647693;
constexpr float kLeastPowerLog2 = -14.0f;  // cos^n below 2^-14 is 0
constexpr int kIntegralSteps = 512;

/// Eq. 7 by t = cos^n theta.
double weightOf(const VplSettings& settings, double t)
{
    if (settings.lobe == VplLobe::phong) return t;
    const double sigma = double(settings.sigma), off = (1.0 - t) / sigma;
    return exp2Exact(-0.5 * off * off * kExponentOfTwo) / (sigma * kRootTwoPi);
}

}  // namespace

float phongExponent(float roughness)
{
    const float alpha = std::clamp(roughness * roughness, kMinSpecularAlpha, 1.0f);
    return 0.5f * (1.0f / (alpha * alpha) - 1.0f);
}

VplLobeWeight::VplLobeWeight(const VplSettings& settings, float exponent)
    : phong_(settings.lobe == VplLobe::phong),
      halfExponent_(0.5f * exponent),
      leastSquare_(exponent > 0.0f ? fastExp2(std::max(-126.0f, kLeastPowerLog2 / halfExponent_)) : 0.0f),
      far_(static_cast<float>(weightOf(settings, 0.0))),
      scale_(static_cast<float>(1.0 / (double(settings.sigma) * kRootTwoPi))),
      gaussian_(static_cast<float>(-0.5 * kExponentOfTwo / (double(settings.sigma) * double(settings.sigma))))
{
}

double lobeIntegral(const VplSettings& settings, double exponent)
{
    // 2 pi int w(c^n) dc. What is left at 90 degrees is apart; the rest by u = c^(n+1), in which it is smooth for any n.
    const double left = weightOf(settings, 0.0), n = exponent;
    double sum = 0.0;
    for (int k = 0; k < kIntegralSteps; ++k) {
        const double t = power((k + 0.5) / kIntegralSteps, n / (n + 1.0));
        sum += (weightOf(settings, t) - left) / t;
    }
    return kHemisphere * (left + sum / (kIntegralSteps * (n + 1.0)));
}

VplLobeIntegral::VplLobeIntegral(const VplSettings& settings)
{
    for (int i = 0; i < kLobeClasses; ++i)
        table_.push_back(static_cast<float>(lobeIntegral(settings, double(phongExponent(float(i) / float(kLobeClasses - 1))))));
}

float VplLobeIntegral::operator()(float roughness) const
{
    const float at = std::clamp(roughness, 0.0f, 1.0f) * float(kLobeClasses - 1);
    const int below = std::min(static_cast<int>(at), kLobeClasses - 2);
    const float fraction = at - float(below);
    return table_[std::size_t(below)] + fraction * (table_[std::size_t(below) + 1] - table_[std::size_t(below)]);
}

}  // namespace lrsm
