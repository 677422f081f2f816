#pragma once

#include "core/scene/scene.h"
#include "core/settings/settings.h"

namespace lrsm {

/// How a light sees the world: RSM texture coordinates and linear depth.
/// u right, v down, both in [0, 1] over the map. Linear depth in [0, 1] over [depthNear, depthFar] metres: distance from the light for a spot or
/// cube face, distance along the axis (from `position`) for a directional light. Ranges begin where the scene's bounds do, so subtracting
/// depthNear keeps precision for a far light, and end where the fitted box does.
struct LightProjection {
    LightType type = LightType::directional;
    Vec3 position{0.0f};                                                             ///< world; directional: centre of the near side of the fitted box
    Vec3 right{1.0f, 0.0f, 0.0f}, up{0.0f, 1.0f, 0.0f}, forward{0.0f, 0.0f, -1.0f};  ///< unit, world
    float halfWidth = 1.0f;  ///< directional: metres from the axis to the map's edge; spot: tan of the half field of view
    float depthNear = 0.0f;  ///< metres
    float depthFar = 1.0f;
    int resolution = 1;  ///< of the RSM, texels

    float depthRange() const { return depthFar - depthNear; }
};

/// Spot: field of view = 2 x outer cone angle. Cube face: 90 degrees. Directional: orthographic square fitted to the bounds, snapped as `snap` says.
/// Widths, depths and the centre's lattice keep kFitMaxError for scenes of some metres.
inline constexpr float kFitMaxError = 1e-6f;
LightProjection fitLightProjection(const Light& light, const Aabb& sceneBounds, int resolution, RsmSnap snap = RsmSnap::texel);

/// The same for the part `fitted` of the scene: width and far end are its, and what stands between it and the light is still within the range.
LightProjection fitLightProjection(const Light& light, const Aabb& fitted, const Aabb& sceneBounds, int resolution, RsmSnap snap = RsmSnap::texel);

struct LightSpacePoint {
    float u = 0.0f, v = 0.0f;  ///< [0, 1] inside the map
    float depth = 0.0f;        ///< linear, [0, 1] inside the scene
    float texelSize = 1.0f;    ///< metres, edge of one RSM texel at this distance, across the light's axis
    bool valid = false;        ///< in front of the light (the map's borders are the sampler's matter)
};
/// Errors, for a light as near to its scene as the scene is wide: u, v and depth absolute, texelSize relative.
inline constexpr float kProjectionMaxError = 5e-7f;  ///< spot, cube face
inline constexpr float kDirectionalProjectionMaxError = 1e-7f;
LightSpacePoint projectToLight(const LightProjection& projection, const Vec3& pWorld);

/// The inverse: the place at (u, v) and linear depth. Within kUnprojectionMaxError, in metres for scenes of some metres, of what was projected.
Vec3 unprojectFromLight(const LightProjection& projection, float u, float v, float depth);
inline constexpr float kUnprojectionMaxError = 5e-6f;

/// World-to-clip for the rasterizer; z/w in [0, 1].
Mat4 clipFromWorld(const LightProjection& projection);

/// Unit direction from p towards the light, as the projection sees it.
Vec3 directionToLight(const LightProjection& projection, const Vec3& pWorld);

}  // namespace lrsm
