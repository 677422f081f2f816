#pragma once

#include "core/scene/scene.h"

#include <optional>
#include <random>

/// An estimator of single-bounce irradiance that shares nothing with the path tracer but the scene's vertices: its own intersections in double
/// precision, its own light, independent uniform random numbers. Flat-shaded diffuse double-sided surfaces without textures, spot lights only.
namespace lrsm::test {

using DVec3 = glm::dvec3;

struct BruteHit {
    double t;
    DVec3 normal;  ///< unit, towards the ray's origin
    DVec3 albedo;
};

class BruteForce {
  public:
    explicit BruteForce(const Scene& scene) : scene_(scene) {}

    std::optional<BruteHit> hit(const DVec3& origin, const DVec3& direction, double tMax = 1e30) const
    {
        std::optional<BruteHit> best;
        for (const Mesh& mesh : scene_.meshes)
            for (const auto& triangle : mesh.triangles) {
                const DVec3 p0(mesh.positions[triangle[0]]), e1 = DVec3(mesh.positions[triangle[1]]) - p0, e2 = DVec3(mesh.positions[triangle[2]]) - p0;
                const DVec3 p = glm::cross(direction, e2);
                const double determinant = glm::dot(e1, p);
                if (std::abs(determinant) < 1e-300) continue;
                const DVec3 s = origin - p0, q = glm::cross(s, e1);
                const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant, t = glm::dot(e2, q) / determinant;
                if (u < 0 || v < 0 || u + v > 1 || t < 1e-9 || t >= (best ? best->t : tMax)) continue;
                DVec3 n = glm::normalize(glm::cross(e1, e2));
                if (glm::dot(n, direction) > 0) n = -n;
                best = {t, n, DVec3(scene_.materials[std::size_t(mesh.material)].baseColor)};
            }
        return best;
    }

    /// Radiance of one light-carrying path: uniform directions over the hemisphere (no cosine weighting).
    DVec3 hemisphereSample(const DVec3& point, const DVec3& normal)
    {
        DVec3 direction = uniformSphere();
        if (glm::dot(direction, normal) < 0) direction = -direction;
        const auto secondary = hit(point + 1e-7 * normal, direction);
        if (!secondary) return DVec3(0);
        const DVec3 position = point + 1e-7 * normal + secondary->t * direction;
        DVec3 radiance(0);
        for (const Light& light : scene_.lights) {
            const DVec3 toLight = DVec3(light.position) - position;
            const double distance = glm::length(toLight), cosine = glm::dot(secondary->normal, toLight) / distance;
            const double onAxis = -glm::dot(toLight, DVec3(light.direction)) / distance;
            if (cosine <= 0 || onAxis <= std::cos(double(light.outerConeAngle))) continue;
            if (hit(position + 1e-7 * secondary->normal, toLight / distance, distance)) continue;
            radiance += secondary->albedo / kPiD * DVec3(light.intensity) * (falloff(light, onAxis) * cosine / (distance * distance));
        }
        return radiance * glm::dot(direction, normal) * (2 * kPiD);
    }

    /// The same from the other end: light leaves the lamp in a uniform direction of its cone, strikes a surface, and is looked at from the point. No
    /// ray is ever sent towards the lamp.
    DVec3 lightSample(const DVec3& point, const DVec3& normal)
    {
        DVec3 sum(0);
        for (const Light& light : scene_.lights) {
            const double cosOuter = std::cos(double(light.outerConeAngle)), onAxis = 1 - uniform() * (1 - cosOuter);
            const double azimuth = 2 * kPiD * uniform(), sine = std::sqrt(1 - onAxis * onAxis);
            const DVec3 axis(light.direction), right = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? DVec3(1, 0, 0) : DVec3(0, 1, 0)));
            const DVec3 direction = axis * onAxis + (right * std::cos(azimuth) + glm::cross(axis, right) * std::sin(azimuth)) * sine;
            const auto lit = hit(DVec3(light.position), direction);
            if (!lit) continue;
            const DVec3 flux = DVec3(light.intensity) * (falloff(light, onAxis) * 2 * kPiD * (1 - cosOuter));
            const DVec3 from = DVec3(light.position) + lit->t * direction + 1e-7 * lit->normal, way = point + 1e-7 * normal - from;
            const double distance = glm::length(way), cosOut = glm::dot(lit->normal, way) / distance, cosIn = -glm::dot(normal, way) / distance;
            if (cosOut <= 0 || cosIn <= 0 || hit(from, way / distance, distance * (1 - 1e-9))) continue;
            sum += flux * lit->albedo / kPiD * (cosOut * cosIn / (distance * distance));
        }
        return sum;
    }

  private:
    static constexpr double kPiD = 3.14159265358979323846;

    static double falloff(const Light& light, double onAxis)
    {
        const double cosInner = std::cos(double(light.innerConeAngle)), cosOuter = std::cos(double(light.outerConeAngle));
        const double ramp = std::clamp((onAxis - cosOuter) / std::max(0.001, cosInner - cosOuter), 0.0, 1.0);
        return ramp * ramp;
    }
    double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    DVec3 uniformSphere()
    {
        const double z = 2 * uniform() - 1, azimuth = 2 * kPiD * uniform(), r = std::sqrt(1 - z * z);
        return {r * std::cos(azimuth), r * std::sin(azimuth), z};
    }

    const Scene& scene_;
    std::mt19937_64 random_{20140623};
};

}  // namespace lrsm::test
