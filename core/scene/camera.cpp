#include "core/scene/camera.h"

#include "core/base/elementary.h"

namespace lrsm {

PixelSpacing pixelSpacing(const Camera& camera, int height)
{
    const double half = camera.perspective ? tangent(0.5 * double(camera.verticalFov)) : 0.5 * double(camera.verticalExtent);
    const float pixel = static_cast<float>(2.0 * half / height);
    return {glm::normalize(glm::cross(camera.forward, camera.up)) * pixel, -camera.up * pixel};
}

CameraRay pixelRay(const Camera& camera, int width, int height, float pixelX, float pixelY)
{
    const Vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));

    // Plane coordinates in units of half the picture's height: y in [-1, 1] upwards, square pixels. In double, so that rays through
    // neighbouring pixels of a large picture keep their spacing.
    const double y = 1.0 - 2.0 * double(pixelY) / height;
    const double x = (2.0 * double(pixelX) - width) / height;

    if (!camera.perspective) {
        const double half = 0.5 * double(camera.verticalExtent);
        return {camera.position + right * float(x * half) + camera.up * float(y * half), camera.forward, camera.nearPlane};
    }
    const double half = tangent(0.5 * double(camera.verticalFov));
    const Vec3 direction = glm::normalize(camera.forward + right * float(x * half) + camera.up * float(y * half));
    return {camera.position, direction, camera.nearPlane / glm::dot(direction, camera.forward)};
}

}  // namespace lrsm
