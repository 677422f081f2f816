#pragma once

#include "conetrace/ism/lights.h"
#include "conetrace/proxies/places.h"

/// Depth maps of the virtual lights, drawn as points and filled by pull and push: [ISM] Sec. 4.
namespace lrsm {

/// Where a light's hemisphere lies in its map: the paraboloid (x, y) / (1 + z) of its frame (Brabec, Annen and Seidel 2002), [-1, 1]^2 over the map.
struct MapPlace {
    float u = 0.0f, v = 0.0f;  ///< texels
    float distance = 0.0f;     ///< m
    float z = 0.0f;            ///< cosine from the light's normal
};
inline MapPlace placeInMap(const VirtualLight& light, const Vec3& p, int resolution)
{
    const Vec3 local = (p - light.position) * light.frame;
    const float distance = std::sqrt(glm::dot(local, local)), scale = 0.5f * float(resolution) / (distance + local.z), middle = 0.5f * float(resolution);
    return {.u = middle + local.x * scale, .v = middle + local.y * scale, .distance = distance, .z = local.z / distance};
}

/// A square of texels a light: distance over `range`, 1 where nothing is.
struct ImperfectMaps {
    int resolution = 0;
    float range = 1.0f;        ///< m: the diagonal of the scene's reach
    float pointRadius = 0.0f;  ///< m, of a disc as large as the surface that a drawn point stands for
    bool unorm = true;         ///< stored as UNORM16
    std::vector<float> depth;  ///< [light * resolution^2 + row * resolution + column], as its storage holds it
    std::uint64_t drawn = 0;   ///< points
    std::uint64_t filled = 0;  ///< texels by pull and push

    std::size_t texels() const { return std::size_t(resolution) * std::size_t(resolution); }
};

template <class Visit>
void forEachArray(const ImperfectMaps& maps, Visit&& visit)
{
    visit(maps.depth, ArrayTraits{maps.depth.size() * (maps.unorm ? sizeof(std::uint16_t) : sizeof(float))});
}

Counters countersOf(const ImperfectMaps& maps);

/// A point as one map sees it. Empty: distance infinite.
struct MapTexel {
    float distance = kInfinity;  ///< m
    float u = 0.0f, v = 0.0f;    ///< of the point, texels of the map
    float reach = 0.0f;          ///< radius of its disc, texels of the map
};

/// The points of one map, `size` x `size`, each nearest of its texel's. Those behind the light, in its plane or nearer than kNearestPoint radii are left out:
/// they are its own surface.
inline constexpr float kNearestPoint = 1.5f, kLeastElevation = 1e-3f;
/// `discs`: each point covers all texels whose centres are within its disc, at the point's distance.
std::vector<MapTexel> drawPoints(const VirtualLight& light, const PointProxies& points, std::span<const std::uint32_t> chosen, float pointRadius,
                                 float reachScale, int size, bool discs);

/// Fills holes ([ISM] Sec. 4.2; the test of reach is Marroquim, Kraus and Cavalcanti's, "Efficient Point-Based Rendering Using Image Reconstruction", 2007).
/// Pull: a texel of the next level is the mean of those of its four whose discs reach its centre and that lie within `depthWindow` m behind the nearest of
/// them. Push: a texel that is empty, or lies farther behind than that, is the mean, by weights 9 : 3 : 3 : 1, of those of the four nearest above it whose
/// discs reach its centre, again within that window. Returns how many texels of the map changed.
std::uint64_t pullPush(std::vector<MapTexel>& map, int size, float depthWindow);

/// One map a light, each of its own window of `settings.points` proxies in one fixed order.
ImperfectMaps renderMaps(const VirtualLights& lights, const PointProxies& points, const Aabb& reach, const Settings& settings);

}  // namespace lrsm
