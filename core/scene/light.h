#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// Light arriving at a point if nothing is in the way.
struct LightSample {
    Vec3 toLight{0.0f, 1.0f, 0.0f};  ///< unit
    float distance = 0.0f;           ///< metres; +inf for a directional light
    Vec3 irradiance{0.0f};           ///< on a plane facing the light, W/m^2 per channel (L_d of Eq. 2, as a delta light gives it)
};

/// The most that sampleLight lets arrive, per channel: sums and products of what a pass makes of it stay far from float's end. A light whose
/// distance rounds to nothing would otherwise be infinite, and a black channel of it NaN.
inline constexpr float kMaxIrradiance = 1e20f;

/// Spot: I / r^2 * falloff(cos); falloff = clamp((cos - cosOuter) / (cosInner - cosOuter), 0, 1)^2, and the range
/// window of KHR_lights_punctual. The extension's sample code puts 0.001 under the quotient, which would take the light of a narrow spot away
/// (all but 0.1 % of one of 1 degree); here the ramp is at least a thousandth of the cone's own 1 - cosOuter wide. Cube face: I / r^2 inside its 90-degree
/// square frustum (a direction on the border of two faces belongs to exactly one). Directional: the intensity.
LightSample sampleLight(const Light& light, const Vec3& pWorld);

/// The same, bit for bit, with what depends on the light alone worked out once: for loops over many points.
class LightSampler {
  public:
    explicit LightSampler(const Light& light);
    LightSample operator()(const Vec3& pWorld) const;

  private:
    Light light_;
    float cosInner_ = 1.0f, cosOuter_ = 0.0f;
    float versineInner_ = 0.0f, versineOuter_ = 1.0f;  ///< 1 - cos, exact for small angles
    bool steep_ = false;                               ///< the ramp is too narrow for a difference of cosines in float
    int face_ = 0;
};

inline bool shines(const Light& light)
{
    return light.intensity != Vec3(0.0f);
}

/// A point light as six cube faces; together they are exactly the point light.
std::vector<Light> splitPointLight(const Vec3& position, const Vec3& intensity, float range, const std::string& name);

}  // namespace lrsm
