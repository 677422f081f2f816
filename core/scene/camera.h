#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// Ray from the eye; `direction` is unit. Points nearer than the camera's near plane are not seen: skip t < `tNear`.
struct CameraRay {
    Vec3 origin{0.0f}, direction{0.0f, 0.0f, -1.0f};
    float tNear = 0.0f;  ///< metres along the ray to the near plane
};

/// How far the picture's ray moves from pixel to pixel at some depth, metres in world space, across the viewing axis.
struct PixelSpacing {
    Vec3 right{0.0f}, down{0.0f};
};

/// At a depth of one metre along the axis; orthographic: at any.
PixelSpacing pixelSpacing(const Camera& camera, int height);

/// The same at the depth of a point, from `pixelSpacing`.
inline PixelSpacing spacingAt(const PixelSpacing& spacing, const Camera& camera, const Vec3& pWorld)
{
    const float scale = camera.perspective ? glm::dot(pWorld - camera.position, camera.forward) : 1.0f;
    return {spacing.right * scale, spacing.down * scale};
}

/// Ray through the point (pixelX, pixelY) of a picture, x right, y down, in pixels: the centre of pixel (i, j) is (i + 0.5, j + 0.5).
/// The G-buffer's pixels and the reference's paths start on these same rays, so that the two pictures can be subtracted.
/// The picture's own proportions decide its width (Camera::aspect does not stretch it). Same bits on every machine.
CameraRay pixelRay(const Camera& camera, int width, int height, float pixelX, float pixelY);

}  // namespace lrsm
