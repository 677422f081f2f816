#include "core/scene/defaults.h"

#include "core/base/elementary.h"

namespace lrsm {
namespace {

Vec3 normalized(const Vec3& v)
{
    return v / std::sqrt(glm::dot(v, v));
}

/// The part of `up` orthogonal to `axis` (both unit, not parallel).
Vec3 orthogonalUp(const Vec3& up, const Vec3& axis)
{
    return normalized(up - axis * glm::dot(up, axis));
}

}  // namespace

Vec3 uprightFor(const Vec3& direction)
{
    const Vec3 up = std::abs(direction.y) < 0.999f ? Vec3(0.0f, 1.0f, 0.0f) : Vec3(0.0f, 0.0f, -1.0f);
    return orthogonalUp(up, direction);
}

void addDefaultLight(Scene& scene)
{
    Light sun;
    sun.name = "default sun";
    sun.type = LightType::directional;
    sun.direction = normalized(Vec3(-0.4f, -1.0f, -0.55f));
    sun.up = uprightFor(sun.direction);
    sun.intensity = Vec3(10.0f);
    scene.lights.push_back(sun);
    scene.notes.emplace_back(kDefaultLightNote);
}

float nearPlaneFor(const Camera& camera, const Aabb& bounds)
{
    constexpr float kOrdinary = 0.01f;
    if (bounds.empty()) return kOrdinary;
    const Vec3 far = glm::max(glm::abs(bounds.min - camera.position), glm::abs(bounds.max - camera.position));
    const float reach = std::sqrt(glm::dot(far, far));
    if (!(reach > 0.0f) || !std::isfinite(reach)) return kOrdinary;
    return std::clamp(kOrdinary, 1e-5f * reach, 1e-2f * reach);
}

void addDefaultCamera(Scene& scene)
{
    const Vec3 extent = scene.bounds.extent(), centre = scene.bounds.centre();
    const float largest = scene.bounds.longestSide();

    // From the front, right and above; along the thin axis where the scene is a sheet, a little aside so that no axis is hit exactly.
    Vec3 toCamera(0.5f, 0.35f, 1.0f);
    if (extent.y < 0.01f * largest)
        toCamera = Vec3(0.2f, 1.0f, 0.5f);
    else if (extent.x < 0.01f * largest)
        toCamera = Vec3(1.0f, 0.25f, 0.2f);
    toCamera = normalized(toCamera);

    // The box's enclosing sphere touches the sides of the field of view.
    Camera camera;
    camera.name = "default camera";
    camera.verticalFov = 0.8f;
    const float radius = 0.5f * std::sqrt(glm::dot(extent, extent));
    const float distance = 1.02f * radius / float(sinCos(0.5 * double(camera.verticalFov)).sin);
    camera.position = centre + distance * toCamera;
    camera.forward = -toCamera;
    camera.up = uprightFor(camera.forward);
    camera.nearPlane = 0.01f * distance;
    scene.cameras.push_back(camera);
    scene.notes.emplace_back(kDefaultCameraNote);
}

}  // namespace lrsm
