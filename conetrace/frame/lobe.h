#pragma once

#include "core/base/math.h"
#include "core/settings/settings.h"

#include <array>

/// Where a pixel looks for what its specular lobe reflects: its mirror direction, or one of 16 points of the lobe, which alternate over 4x4 pixels as the
/// diffuse cones' rotations do and are averaged by filterSpecular.
namespace lrsm {

/// Mean over the lobe of L = sum of weight L / sum of weight.
struct LobeDirection {
    Vec3 direction{0.0f};  ///< world space, unit
    float weight = 0.0f;   ///< 0: below the surface, nothing is seen there
};

/// One of the 16 points: a place in the unit disk of visible normals (reflectLobe, core/scene/brdf.h), and what it stands for.
struct LobePoint {
    float x = 0.0f, y = 0.0f, weight = 0.0f;
};
std::array<LobePoint, 16> lobePoints();

/// Smoother surfaces show mirrored things, which an average over 4x4 pixels would blur: a lobe of this one, half-angle 4.6 degrees, is four pixels of a
/// picture with 50 lines.
inline constexpr float kLeastSampledRoughness = 0.2f;
inline bool lobeIsWide(float roughness)
{
    return roughness >= kLeastSampledRoughness;
}

class SpecularLobes {
  public:
    SpecularLobes() = default;  ///< all look where a mirror does
    explicit SpecularLobes(const ConeSettings& settings);

    /// Are wide lobes sampled? Else all look where a mirror does.
    bool sampling() const { return sampling_; }
    /// `toEye` unit; `rotation`: of the pixel, 0 .. 15.
    LobeDirection direction(const Vec3& normal, const Vec3& toEye, float roughness, int rotation) const;

  private:
    bool sampling_ = false;
    std::array<LobePoint, 16> points_;
};

}  // namespace lrsm
