#include "lrsm/light_projection.h"

#include "core/base/elementary.h"

namespace lrsm {

namespace {

/// far > near by more than the rounding of coordinates, so that depths can be divided by the range, whatever the scene (a point, a plane
/// facing the light). Relative to the map's width or the light's distance: the scene's unit must not matter.
void widenEmptyRange(LightProjection& projection)
{
    const float reach = projection.depthNear > 0.0f ? projection.depthNear : projection.depthFar;
    const float size = projection.type == LightType::directional ? 0.2f * projection.halfWidth : reach;
    const float least = size > 0.0f ? 1e-5f * size : 1e-6f;
    projection.depthFar = std::max(projection.depthFar, projection.depthNear + least);
}

/// Bounds of a box along the light's axes.
Aabb alongLight(const LightProjection& projection, const Aabb& box)
{
    Aabb inLight;
    for (unsigned i = 0; i < 8; ++i) {
        const Vec3 corner = box.corner(i);
        inLight.include(Vec3(glm::dot(corner, projection.right), glm::dot(corner, projection.up), glm::dot(corner, projection.forward)));
    }
    return inLight;
}

/// Up to the next sixteenth of a power of two.
double roundedUp(double length)
{
    if (!(length > 0.0)) return length;
    const double step = std::ldexp(1.0, std::ilogb(length) - 4);
    return std::ceil(length / step) * step;
}

void fitDirectional(LightProjection& projection, const Aabb& bounds, const Aabb& sceneBounds, RsmSnap snap)
{
    const Aabb box = alongLight(projection, bounds);
    const Vec3 low(box.min.x, box.min.y, alongLight(projection, sceneBounds).min.z), high = box.max;

    // One texel more than the bounds need pays for moving the centre to a whole texel of the light's world-fixed lattice.
    // A map thinner than a millionth of the scene (a line along the light) would be all rounding.
    const double longest = std::max({double(bounds.max.x) - bounds.min.x, double(bounds.max.y) - bounds.min.y, double(bounds.max.z) - bounds.min.z});
    const double width = std::max({double(high.x) - low.x, double(high.y) - low.y, longest > 0.0 ? 1e-6 * longest : 1e-6});
    const glm::dvec3 diagonal = glm::dvec3(bounds.max) - glm::dvec3(bounds.min);
    const double extent = snap == RsmSnap::sphere ? std::max(width, roundedUp(std::sqrt(glm::dot(diagonal, diagonal)))) : width;
    const double texel = extent / (snap == RsmSnap::none ? projection.resolution : projection.resolution - 1);
    const auto snapped = [=](float a, float b) {
        const double centre = 0.5 * (double(a) + b);
        return snap == RsmSnap::none ? centre : std::floor(centre / texel + 0.5) * texel;
    };
    projection.halfWidth = static_cast<float>(0.5 * texel * projection.resolution);
    projection.position =
        projection.right * static_cast<float>(snapped(low.x, high.x)) + projection.up * static_cast<float>(snapped(low.y, high.y)) + projection.forward * low.z;
    projection.depthNear = 0.0f;
    projection.depthFar = high.z - low.z;
}

void fitPerspective(LightProjection& projection, const Aabb& bounds, const Aabb& sceneBounds)
{
    const Vec3 closest = glm::clamp(projection.position, sceneBounds.min, sceneBounds.max);
    projection.depthNear = glm::length(closest - projection.position);
    projection.depthFar = projection.depthNear;
    for (unsigned i = 0; i < 8; ++i) projection.depthFar = std::max(projection.depthFar, glm::length(bounds.corner(i) - projection.position));
}

/// Axial distance of the near plane of a spot or cube face, metres. Outside the bounds nothing is nearer than depthNear, seen in the map's
/// corner at worst; inside them, as near as a 10^4th of the scene still leaves float depths millimetres apart in a scene of tens of metres.
float nearPlaneOf(const LightProjection& projection)
{
    const float cornerCosine = 1.0f / std::sqrt(1.0f + 2.0f * projection.halfWidth * projection.halfWidth);
    return std::max(1e-4f * projection.depthFar, 0.99f * projection.depthNear * cornerCosine);
}

/// Row `row` of a matrix: dot(axis, p - origin) * scale + shift * w.
void setRow(Mat4& m, int row, const Vec3& axis, const Vec3& origin, float scale, float shift)
{
    for (int k = 0; k < 3; ++k) m[k][row] = axis[k] * scale;
    const double offset = double(axis.x) * origin.x + double(axis.y) * origin.y + double(axis.z) * origin.z;
    m[3][row] = static_cast<float>(double(shift) - offset * scale);
}

}  // namespace

LightProjection fitLightProjection(const Light& light, const Aabb& sceneBounds, int resolution, RsmSnap snap)
{
    return fitLightProjection(light, sceneBounds, sceneBounds, resolution, snap);
}

LightProjection fitLightProjection(const Light& light, const Aabb& fitted, const Aabb& sceneBounds, int resolution, RsmSnap snap)
{
    const Aabb point{Vec3(0.0f), Vec3(0.0f)};
    const Aabb& whole = sceneBounds.empty() ? point : sceneBounds;
    const Aabb& bounds = fitted.empty() ? whole : fitted;
    LightProjection projection;
    projection.type = light.type;
    projection.position = light.position;
    projection.forward = light.direction;
    projection.right = glm::normalize(glm::cross(light.direction, light.up));
    projection.up = glm::cross(projection.right, light.direction);
    projection.resolution = std::max(resolution, 2);
    switch (light.type) {
    case LightType::directional: fitDirectional(projection, bounds, whole, snap); break;
    case LightType::spot:
        projection.halfWidth = static_cast<float>(tangent(light.outerConeAngle));
        fitPerspective(projection, bounds, whole);
        break;
    case LightType::cubeFace:
        projection.halfWidth = 1.0f;
        fitPerspective(projection, bounds, whole);
        break;
    }
    widenEmptyRange(projection);
    return projection;
}

LightSpacePoint projectToLight(const LightProjection& projection, const Vec3& pWorld)
{
    const Vec3 d = pWorld - projection.position;
    const float x = glm::dot(d, projection.right), y = glm::dot(d, projection.up), z = glm::dot(d, projection.forward);
    LightSpacePoint point;
    if (projection.type == LightType::directional) {
        point.valid = true;
        point.depth = (z - projection.depthNear) / projection.depthRange();
        point.texelSize = 2.0f * projection.halfWidth / float(projection.resolution);
        point.u = 0.5f + 0.5f * x / projection.halfWidth;
        point.v = 0.5f - 0.5f * y / projection.halfWidth;
        return point;
    }
    if (!(z > 0.0f)) return point;
    const float halfWidth = z * projection.halfWidth;  // metres, at this distance
    point.valid = true;
    point.depth = (glm::length(d) - projection.depthNear) / projection.depthRange();
    point.texelSize = 2.0f * halfWidth / float(projection.resolution);
    point.u = 0.5f + 0.5f * x / halfWidth;
    point.v = 0.5f - 0.5f * y / halfWidth;
    return point;
}

Vec3 unprojectFromLight(const LightProjection& projection, float u, float v, float depth)
{
    using DVec3 = glm::dvec3;
    const double distance = double(projection.depthNear) + double(depth) * double(projection.depthRange());
    const double x = (2.0 * double(u) - 1.0) * double(projection.halfWidth), y = (1.0 - 2.0 * double(v)) * double(projection.halfWidth);
    const DVec3 across = x * DVec3(projection.right) + y * DVec3(projection.up), forward(projection.forward), from(projection.position);
    if (projection.type == LightType::directional) return Vec3(from + across + distance * forward);
    return Vec3(from + (distance / std::sqrt(1.0 + x * x + y * y)) * (across + forward));
}

Mat4 clipFromWorld(const LightProjection& projection)
{
    Mat4 m(0.0f);
    const float invWidth = 1.0f / projection.halfWidth;
    setRow(m, 0, projection.right, projection.position, invWidth, 0.0f);
    setRow(m, 1, projection.up, projection.position, invWidth, 0.0f);
    if (projection.type == LightType::directional) {
        // A margin of 1/16 of the range in front: the bounds' nearest points must survive the near plane's rounding.
        const float scale = 1.0f / (1.125f * projection.depthRange());
        setRow(m, 2, projection.forward, projection.position, scale, 0.0625f / 1.125f);
        m[3][3] = 1.0f;
    } else {
        const float near = nearPlaneOf(projection), far = std::max(projection.depthFar, 2.0f * near);
        const float scale = far / (far - near);
        setRow(m, 2, projection.forward, projection.position, scale, -near * scale);
        setRow(m, 3, projection.forward, projection.position, 1.0f, 0.0f);
    }
    return m;
}

Vec3 directionToLight(const LightProjection& projection, const Vec3& pWorld)
{
    if (projection.type == LightType::directional) return -projection.forward;
    const Vec3 toLight = projection.position - pWorld;
    const float length = glm::length(toLight);
    return length > 0.0f ? toLight / length : -projection.forward;
}

}  // namespace lrsm
