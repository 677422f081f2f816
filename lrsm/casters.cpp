#include "lrsm/casters.h"

#include "core/scene/cut_polygon.h"

#include <array>

namespace lrsm {
namespace {

using DVec3 = glm::dvec3;

/// Light-space axes of a directional light.
struct Axes {
    DVec3 right, up, forward;
    explicit Axes(const Light& light)
        : right(glm::normalize(glm::cross(DVec3(light.direction), DVec3(light.up)))), up(glm::cross(right, DVec3(light.direction))), forward(light.direction)
    {
    }
    DVec3 toLight(const Vec3& p) const { return {glm::dot(right, DVec3(p)), glm::dot(up, DVec3(p)), glm::dot(forward, DVec3(p))}; }
    Vec3 toWorld(const DVec3& p) const { return Vec3(right * p.x + up * p.y + forward * p.z); }
};

template <class Visit>
void forEachTriangleOutside(const Scene& scene, const Aabb& box, Visit&& visit)
{
    for (const Mesh& mesh : scene.meshes)
        for (const auto& t : mesh.triangles) {
            const std::array<Vec3, 3> p = {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
            if (!(box.contains(p[0]) && box.contains(p[1]) && box.contains(p[2]))) visit(p);
        }
}

Aabb overFootprint(const Aabb& reach, const Scene& scene, const Light& light)
{
    const Axes axes(light);
    DVec3 low(1e300), high(-1e300);
    for (unsigned i = 0; i < 8; ++i) {
        const DVec3 p = axes.toLight(reach.corner(i));
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    Aabb box = reach;
    forEachTriangleOutside(scene, reach, [&](const std::array<Vec3, 3>& triangle) {
        CutPolygon piece;
        for (const Vec3& p : triangle) piece.push(axes.toLight(p));
        for (int axis = 0; axis < 2; ++axis) piece = cut(cut(piece, axis, -1.0, low[axis]), axis, 1.0, high[axis]);
        for (std::size_t k = 0; k < piece.count; ++k)
            if (piece.corner[k].z < low.z) box.include(axes.toWorld(piece.corner[k]));
    });
    return box;
}

Aabb beforeFarEnd(const Aabb& reach, const Scene& scene, const Light& light)
{
    float farEnd = 0.0f;
    for (unsigned i = 0; i < 8; ++i) farEnd = std::max(farEnd, glm::length(reach.corner(i) - light.position));
    Aabb box = reach;
    forEachTriangleOutside(scene, reach, [&](const std::array<Vec3, 3>& p) {
        const Vec3 low = glm::min(glm::min(p[0], p[1]), p[2]), high = glm::max(glm::max(p[0], p[1]), p[2]), closest = glm::clamp(light.position, low, high);
        if (glm::length(closest - light.position) <= farEnd) box.include(closest);
    });
    return box;
}

}  // namespace

Aabb withCasters(const Aabb& reach, const Scene& scene, const Light& light)
{
    return light.type == LightType::directional ? overFootprint(reach, scene, light) : beforeFarEnd(reach, scene, light);
}

}  // namespace lrsm
