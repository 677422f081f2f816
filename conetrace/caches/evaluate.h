#pragma once

#include "conetrace/caches/atlas.h"
#include "conetrace/caches/places.h"
#include "conetrace/frame/gather.h"

#include <cmath>

/// What pixels take from caches: [C] Sec. 3.3.
namespace lrsm {

/// Everything that a pixel reads.
struct CacheWorld {
    const GBuffer& gbuffer;
    const Camera& camera;
    const PixelClusters& clusters;
    const CachePlaces& places;
    const CacheAtlas& atlas;
    const CacheSettings& settings;
};

struct CacheWeight {
    float world = 0.0f, screen = 0.0f;  ///< w_w, w_s: (1 - (distance over radius)^2)+
    float least() const { return std::min(world, screen); }
};

/// Of a cache for a pixel. The radius on screen is rc_radius tiles; in the world it is as long as that at the cache's depth.
inline CacheWeight cacheWeight(const CacheWorld& world, std::uint32_t cache, int x, int y, const Vec3& position)
{
    const float radius = world.settings.radius * float(world.clusters.tile);
    const auto pixel = static_cast<int>(world.places.pixels[cache]);
    const auto dx = float(x - pixel % world.gbuffer.width), dy = float(y - pixel / world.gbuffer.width);
    const Vec3 d = position - world.places.positions[cache];
    const float worldRadius = radius * world.places.pixelSizes[cache];
    return {std::max(0.0f, 1.0f - glm::dot(d, d) / (worldRadius * worldRadius)), std::max(0.0f, 1.0f - (dx * dx + dy * dy) / (radius * radius))};
}

/// visit(cache, weight) for the caches that a covered pixel reads, w > 0, those of a tile in their order; for its own cluster's with w = 1 where there is none.
/// So every covered pixel reads one: each belongs to a cluster, and each cluster has a cache.
template <class Visit>
void forCachesOf(const CacheWorld& world, int x, int y, const Visit& visit)
{
    const PixelClusters& clusters = world.clusters;
    const std::size_t pixel = world.gbuffer.position.index(x, y);
    const Vec3 position = world.gbuffer.position.texels[pixel], normal = world.gbuffer.normal.texels[pixel];
    const float radius = world.settings.radius * float(clusters.tile), perTile = 1.0f / float(clusters.tile);
    const auto tileAt = [&](float at, int tiles) { return std::clamp(static_cast<int>(at * perTile), 0, tiles - 1); };
    const int xEnd = tileAt(float(x) + radius, clusters.tilesX), yEnd = tileAt(float(y) + radius, clusters.tilesY);
    bool any = false;
    for (int tileY = tileAt(float(y) - radius, clusters.tilesY); tileY <= yEnd; ++tileY)
        for (int tileX = tileAt(float(x) - radius, clusters.tilesX); tileX <= xEnd; ++tileX) {
            const auto tile = std::size_t(tileY) * std::size_t(clusters.tilesX) + std::size_t(tileX);
            for (std::uint32_t cache = clusters.tileFirst[tile]; cache < clusters.tileFirst[tile + 1]; ++cache) {
                if (glm::dot(normal, world.places.normals[cache]) < world.settings.minCosine) continue;
                const float weight = cacheWeight(world, cache, x, y, position).least();
                if (!(weight > 0.0f)) continue;
                any = true;
                visit(cache, weight);
            }
        }
    if (!any) visit(clusters.clusterOf.texels[pixel] - 1, 1.0f);
}

/// A direction in the cache's frame.
inline Vec3 inCacheFrame(const CacheWorld& world, std::uint32_t cache, const Vec3& direction)
{
    return direction * world.places.frames[cache];
}

/// Irradiance (times the pre-exposure) of a surface with this normal, and opacity of its hemisphere.
Vec4 diffuseOf(const CacheWorld& world, std::uint32_t cache, const Vec3& normal);
/// Mean radiance (times the pre-exposure) and opacity about a direction at a mip level, trilinear.
Vec4 radianceOf(const CacheWorld& world, std::uint32_t cache, const Vec3& direction, float level);

/// Level whose texels have the solid angle of a lobe, log2(Omega N^2 / 2 pi) / 2 in [0, log2 N]. A Phong lobe of exponent n stands for GGX's: alpha = (2n +
/// 1)^-1/2. `equivalent`: Omega = 2 pi (2n + 1) / (n + 1)^2; `cutoff`: the cone at whose rim the lobe falls to 1 %, 2 pi (1 - .01^(1/n)). Error <=
/// kLobeLevelMaxError.
inline constexpr float kLobeLevelMaxError = 3e-6f;
float lobeLevel(float roughness, int resolution, CacheLobe lobe);

/// All covered pixels, each the mean of its caches by weight; parallel over tiles.
Gathered evaluateCaches(const CacheWorld& world, const Requirements& needs);

/// What one pixel takes.
struct CachedLight {
    Vec3 irradiance{0.0f}, specular{0.0f};
    float opacity = 0.0f;
    int caches = 0;
};
CachedLight evaluatePixel(const CacheWorld& world, bool specular, int x, int y);

}  // namespace lrsm
