#pragma once

#include "core/bvh/embree_scene.h"
#include "core/scene/light.h"
#include "reference/sobol.h"

#include <optional>

/// The rays of one light as the points of a unit square.
namespace lrsm {

/// Where the light's ray to a point lies in the square, and how dense the square is there.
struct LightCoordinates {
    UnitPoint at;
    double perArea = 0.0;  ///< |d(u, v) / dA|, A the area across the ray at the point, 1/m^2
};

/// (u, v) = ((a + 1) / 2, (b + 1) / 2), a and b in [-1, 1]:
///
/// - directional: a, b run over the rectangle across the light that holds the scene; |d(u, v) / dA| = 1 / its area;
/// - spot: the Lambert azimuthal projection, which keeps areas, with the cone's border on the unit circle: a^2 + b^2 = (1 - cos) / (1 - cosOuter),
///   |d(u, v) / dA| = 1 / (8 (1 - cosOuter) r^2);
/// - cube face: the projection from the light on the plane at distance 1, |d(u, v) / dA| = (1 + a^2 + b^2)^(3/2) / (4 r^2).
class LightMap {
  public:
    LightMap(const Light& light, const Aabb& sceneBounds);

    /// The ray of a point of the square; none outside a spot's circle. The light sees fronts only, as an eye. It starts `offset` off a spot or cube face, so
    /// that what the light stands on is not in its way.
    std::optional<Ray> ray(UnitPoint at, float offset) const;

    /// Of the ray through `p`; none where the light does not shine.
    std::optional<LightCoordinates> coordinates(const Vec3& p) const;

  private:
    using DVec3 = glm::dvec3;
    LightType type_;
    DVec3 origin_;  ///< the light; of a directional one the middle of the rectangle, in front of the scene
    DVec3 right_, up_, axis_;
    double halfWidth_ = 1.0, halfHeight_ = 1.0;  ///< of a directional light's rectangle, metres
    double versineOuter_ = 1.0;                  ///< 1 - cos of a spot's outer angle
};

}  // namespace lrsm
