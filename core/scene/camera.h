#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// Ray from the eye; `direction` is unit. Points nearer than the camera's near plane are not seen: skip t < `tNear`.
struct CameraRay {
    Vec3 origin{0.0f}, direction{0.0f, 0.0f, -1.0f};
    float tNear = 0.0f;  ///< metres along the ray to the near plane
};

/// Ray through the point (pixelX, pixelY) of a picture, x right, y down, in pixels: the centre of pixel (i, j) is (i + 0.5, j + 0.5).
/// The G-buffer's pixels and the reference's paths start on these same rays, so that the two pictures can be subtracted.
/// The picture's own proportions decide its width (Camera::aspect does not stretch it). Same bits on every machine.
CameraRay pixelRay(const Camera& camera, int width, int height, float pixelX, float pixelY);

}  // namespace lrsm
