#pragma once

#include "core/scene/camera.h"
#include "core/scene/scene.h"

#include <limits>

/// Ray casting by brute force in double: every triangle, every ray (Moeller and Trumbore, "Fast, Minimum Storage Ray/Triangle
/// Intersection", 1997).
namespace oracle {

struct RayHit {
    int mesh = -1;
    double t = std::numeric_limits<double>::infinity();
    glm::dvec3 position{0.0}, normal{0.0};  ///< normal towards the ray's origin
    double cosine = 0.0;                    ///< between ray and plane normal
};

/// First hit beyond tMin. Back faces of single-sided materials are passed when `cullBack`.
inline RayHit closestHit(const lrsm::Scene& scene, const glm::dvec3& origin, const glm::dvec3& direction, double tMin, bool cullBack)
{
    RayHit best;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const lrsm::Mesh& mesh = scene.meshes[m];
        const bool cull = cullBack && !scene.materials[std::size_t(mesh.material)].doubleSided;
        for (const auto& t : mesh.triangles) {
            const glm::dvec3 a(mesh.positions[t[0]]), e1 = glm::dvec3(mesh.positions[t[1]]) - a, e2 = glm::dvec3(mesh.positions[t[2]]) - a;
            const glm::dvec3 p = glm::cross(direction, e2);
            const double det = glm::dot(e1, p);
            if (det == 0.0 || (cull && det < 0.0)) continue;
            const glm::dvec3 s = origin - a, q = glm::cross(s, e1);
            const double u = glm::dot(s, p) / det, v = glm::dot(direction, q) / det, along = glm::dot(e2, q) / det;
            if (u < 0 || v < 0 || u + v > 1 || along <= tMin || along >= best.t) continue;
            const glm::dvec3 n = glm::normalize(glm::cross(e1, e2));
            const double cosine = glm::dot(n, direction);
            best = {int(m), along, origin + along * direction, cosine > 0 ? -n : n, cosine};
        }
    }
    return best;
}

inline RayHit closestHit(const lrsm::Scene& scene, const lrsm::CameraRay& ray)
{
    return closestHit(scene, glm::dvec3(ray.origin), glm::dvec3(ray.direction), ray.tNear, true);
}

}  // namespace oracle
