#pragma once

#include "apps/validate/extremes/catalogue.h"
#include "core/scene/scene.h"

#include <limits>

/// Small worlds that the cases bend out of shape, and what is measured on a picture of them.
namespace lrsm::extremes {

inline constexpr float kDegree = kPi / 180.0f;
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct World {
    Scene scene;
    Camera camera;
};

/// Little of everything, so that a frame takes milliseconds: 32^3 voxels, an RSM of 64^2, six cones; `balanced` otherwise.
Settings smallSettings(Mode mode);
/// The paper's own estimator at the same size.
Settings smallLiteral(Mode mode);

/// A closed room of 2 m about the origin, a block in it, a spot under its ceiling, the camera inside. `specular`: the block is glossy.
World room(bool specular = false);
/// A room of other size or place. Light and camera go along; irradiance stays as it is.
World scaledRoom(double factor);
World movedRoom(const glm::dvec3& offset);
/// A wall of albedo 1/2 at z = 0, edge 2 m, seen from z = 3; lit by a spot at (0, 0, distance) of 1 W/sr that looks at its middle.
World litWall(float distance, float innerConeDegrees, float outerConeDegrees);
/// A sphere of radius 1 lit from its centre: irradiance is albedo * intensity everywhere.
World furnaceSphere(float albedo, float intensity, int subdivisions = 4);

Frame renderWorld(const World& world, const Settings& settings, int width = 16, int height = 12);

/// Means over covered pixels, of the three channels.
double meanOf(const Image<Vec3>& image, const GBuffer& gbuffer);
/// Root mean square of the difference, over the mean of b. Pictures of the same size.
double relativeDifference(const Image<Vec3>& a, const Image<Vec3>& b, double scaleA = 1.0);
bool allZero(const Image<Vec3>& image);

}  // namespace lrsm::extremes
