#pragma once

#include "core/base/elementary.h"
#include "core/base/math.h"
#include "core/settings/settings.h"

#include <vector>

/// Virtual point lights: what of one reaches a surface. Proxies and imperfect shadow maps share it.
namespace lrsm {

/// How a light near by is kept finite (vpl_singularity): cos cos' / (d^2 + softening), `most` at most.
struct VplNear {
    float softening = 0.0f;  ///< m^2
    float most = kInfinity;  ///< 1 / m^2
};
/// Of lights that stand for `area` m^2 of surface. `disc` is exact on the axis of a disc of that area: pi L r^2 / (d^2 + r^2).
inline VplNear vplNear(const VplSettings& settings, float area)
{
    switch (settings.singularity) {
    case VplSingularity::disc: return {.softening = area / kPi};
    case VplSingularity::clamp: return {.most = settings.clamp / area};
    case VplSingularity::none: break;
    }
    return {};
}

/// d^2 no smaller than this: what stands on a light itself is lit by others.
inline constexpr float kLeastDistance2 = 1e-12f;

/// cos cos' / d^2 of a light at `toLight` from a receiver, kept finite: times area and radiance it is the light's irradiance (f_vpl of Eq. 6).
inline float vplGeometry(const VplNear& near, const Vec3& toLight, const Vec3& receiverNormal, const Vec3& lightNormal)
{
    const float d2 = std::max(glm::dot(toLight, toLight), kLeastDistance2);
    const float cosines = std::max(0.0f, glm::dot(receiverNormal, toLight)) * std::max(0.0f, -glm::dot(lightNormal, toLight));
    return std::min(near.most, cosines / (d2 * (d2 + near.softening)));
}

/// Exponent of the Phong lobe that stands for GGX's at this roughness: alpha = (2n + 1)^-1/2. 0 where alpha is 1.
float phongExponent(float roughness);

/// Eq. 7: weight of light from an angle theta off the mirror direction. w = exp(-((1 - cos^n theta) / sigma)^2 / 2) / (sigma sqrt(2 pi)), or cos^n theta
/// (vpl_lobe); cos^n theta is 0 beyond 90 degrees. Error <= kLobeWeightMaxError of the lobe's own maximum.
class VplLobeWeight {
  public:
    VplLobeWeight(const VplSettings& settings, float exponent);
    float ofCosine(float cosine) const { return ofSquare(cosine > 0.0f ? cosine * cosine : 0.0f); }
    /// By the square of a cosine that is not negative.
    float ofSquare(float cosine2) const
    {
        if (!(cosine2 > leastSquare_)) return far_;
        const float power = fastExp2(halfExponent_ * fastLog2(cosine2));
        if (phong_) return power;
        const float off = 1.0f - power;
        return scale_ * fastExp2(off * off * gaussian_);
    }
    /// Squared cosines up to this have the weight of 90 degrees.
    float leastSquare() const { return leastSquare_; }
    float farWeight() const { return far_; }

  private:
    bool phong_;
    float halfExponent_, leastSquare_, far_, scale_, gaussian_;
};
inline constexpr float kLobeWeightMaxError = 3e-4f;

/// The integral of the weight over the hemisphere about the mirror direction, by roughness: made once a frame, linear between kLobeClasses values.
class VplLobeIntegral {
  public:
    explicit VplLobeIntegral(const VplSettings& settings);
    float operator()(float roughness) const;

  private:
    std::vector<float> table_;
};
inline constexpr int kLobeClasses = 256;
/// The same at one exponent, in double; relative error <= kLobeIntegralMaxError.
double lobeIntegral(const VplSettings& settings, double exponent);
inline constexpr double kLobeIntegralMaxError = 1e-3;

}  // namespace lrsm
