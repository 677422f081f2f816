#pragma once

#include "core/base/arrays.h"
#include "core/base/counters.h"
#include "core/scene/scene.h"
#include "core/settings/settings.h"

#include <cstdint>
#include <vector>

/// Points that stand for the scene's surfaces: [P] Sec. 3.1. [P] here is the paper on voxelized point proxies with a visibility filter (2014).
namespace lrsm {

/// Parallel arrays, triangle by triangle in the scene's order. Each point stands for `area` of surface, whatever triangle it lies on.
struct PointProxies {
    float area = 0.0f;                      ///< a = A / N, m^2: A is the area of all triangles within the scene's reach, N pp_count
    std::vector<Vec3> positions;            ///< world
    std::vector<Vec3> normals;              ///< geometric, unit, of the triangle's front
    std::vector<Vec3> shadingNormals;       ///< unit
    std::vector<Vec3> albedos;              ///< diffuse, filtered over the disc
    std::vector<std::uint8_t> doubleSided;  ///< 1: reflects on both sides

    /// m, of a disc as large as the surface that a proxy stands for.
    float radius() const { return std::sqrt(area / kPi); }
    std::size_t size() const { return positions.size(); }
};

template <class Visit>
void forEachArray(const PointProxies& proxies, Visit&& visit)
{
    // Position in float32, normals in 10 bits a component, albedo in RGBA8 whose alpha tells double-sided ones.
    constexpr std::size_t kGpuPosition = 12, kGpuPacked = 4;
    visit(proxies.positions, ArrayTraits{proxies.size() * kGpuPosition});
    visit(proxies.normals, ArrayTraits{proxies.size() * kGpuPacked});
    visit(proxies.shadingNormals, ArrayTraits{proxies.size() * kGpuPacked});
    visit(proxies.albedos, ArrayTraits{proxies.size() * kGpuPacked});
    visit(proxies.doubleSided, ArrayTraits{0});
}

inline Counters countersOf(const PointProxies& proxies)
{
    return {{"proxies", double(proxies.size())}};
}

/// Of triangle i, n_i = floor(x) + [h < x - floor(x)] for x = N A_i / A and the triangle's own random number h in [0, 1), so that n_i is x in the mean. ([P]
/// prints the comparison the other way round.)
inline std::uint32_t proxyCount(double x, double hash)
{
    const double whole = std::floor(x);
    return static_cast<std::uint32_t>(whole) + (hash < x - whole ? 1u : 0u);
}

/// h of a triangle by its place: of its centroid, in units of 2^-20 of the reach's longest side; or by its number.
double placeHash(const glm::dvec3& centroid, const Aabb& reach);
double indexHash(std::uint32_t mesh, std::uint32_t triangle);

/// Element i of the Halton sequence in a prime base, in [0, 1); element 0 is 0.
double halton(std::uint32_t i, std::uint32_t base);

/// b1 and b2 of a triangle's point for (u, v) in [0, 1)^2: uniform where these are.
glm::dvec2 trianglePoint(double u, double v);

/// Triangles are cut where the scene's reach ends; points where an alpha mask leaves nothing are dropped.
PointProxies placeProxies(const Scene& scene, const ProxySettings& settings, TextureFilter textureFilter);

}  // namespace lrsm
