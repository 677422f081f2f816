#include "conetrace/caches/evaluate.h"

#include "conetrace/frame/tiles.h"
#include "core/base/elementary.h"
#include "core/scene/brdf.h"

namespace lrsm {
namespace {

/// Bilinear among n x n values, at a place in units of their spacing from the first; clamped at the square's edge, the hemisphere's horizon.
Vec4 sampleSquare(const Vec4* texels, int n, const Vec2& place)
{
    const Vec2 at = glm::clamp(place, Vec2(0.0f), Vec2(float(n - 1)));
    const int column = std::min(static_cast<int>(at.x), std::max(0, n - 2)), row = std::min(static_cast<int>(at.y), std::max(0, n - 2));
    const float fx = at.x - float(column), fy = at.y - float(row);
    const Vec4* top = texels + row * n + column;
    const Vec4* bottom = n > 1 ? top + n : top;
    const int right = n > 1 ? 1 : 0;
    const Vec4 above = top[0] + fx * (top[right] - top[0]), below = bottom[0] + fx * (bottom[right] - bottom[0]);
    return above + fy * (below - above);
}

Vec4 sampleLevel(const CacheAtlas& atlas, std::uint32_t cache, int level, const Vec2& uv)
{
    const int n = atlas.resolution >> level;
    return sampleSquare(atlas.levels[std::size_t(level)].data() + std::size_t(cache) * std::size_t(n * n), n, uv * float(n) - 0.5f);
}

/// What the tiles count.
struct ReadCounts {
    std::uint64_t pixels = 0, caches = 0;
    ReadCounts& operator+=(const ReadCounts& other)
    {
        pixels += other.pixels;
        caches += other.caches;
        return *this;
    }
};

/// Weighted mean over a pixel's caches of what lies about its mirror direction. Caches whose horizon it is below see nothing there; where all are such, the
/// pixel's own is read at its horizon.
Vec3 specularOf(const CacheWorld& world, std::size_t pixel, int x, int y)
{
    const GBuffer& gbuffer = world.gbuffer;
    const Vec3 toEye = glm::normalize(directionToEye(world.camera, gbuffer.position.texels[pixel]));
    const Vec3 mirror = mirrorDirection(gbuffer.normal.texels[pixel], toEye);
    if (!(glm::dot(mirror, gbuffer.geometricNormal.texels[pixel]) > 0.0f)) return Vec3(0.0f);
    const Vec3 direction = glm::normalize(mirror);
    const float level = lobeLevel(gbuffer.roughness.texels[pixel], world.atlas.resolution, world.settings.lobe);
    Vec4 sum(0.0f);
    float weights = 0.0f;
    forCachesOf(world, x, y, [&](std::uint32_t cache, float weight) {
        if (!(glm::dot(direction, world.places.normals[cache]) > 0.0f)) return;
        sum += weight * radianceOf(world, cache, direction, level);
        weights += weight;
    });
    if (!(weights > 0.0f)) return Vec3(radianceOf(world, world.clusters.clusterOf.texels[pixel] - 1, direction, level)) / world.atlas.preExposure;
    return Vec3(sum) / (weights * world.atlas.preExposure);
}

}  // namespace

Vec4 diffuseOf(const CacheWorld& world, std::uint32_t cache, const Vec3& normal)
{
    const Vec2 uv = squareFromHemisphere(inCacheFrame(world, cache, normal), world.settings.mapping);
    return sampleSquare(world.atlas.diffuse.data() + std::size_t(cache) * std::size_t(kDiffuseNodes * kDiffuseNodes), kDiffuseNodes,
                        uv * float(kDiffuseNodes - 1));
}

Vec4 radianceOf(const CacheWorld& world, std::uint32_t cache, const Vec3& direction, float level)
{
    const Vec2 uv = squareFromHemisphere(inCacheFrame(world, cache, direction), world.settings.mapping);
    const int last = static_cast<int>(world.atlas.levels.size()) - 1, fine = std::min(static_cast<int>(level), last);
    const Vec4 finer = sampleLevel(world.atlas, cache, fine, uv);
    if (fine == last) return finer;
    const float fraction = level - float(fine);
    return fraction == 0.0f ? finer : finer + fraction * (sampleLevel(world.atlas, cache, fine + 1, uv) - finer);
}

float lobeLevel(float roughness, int resolution, CacheLobe lobe)
{
    const float alpha = std::clamp(roughness * roughness, 0.0f, 1.0f), alpha2 = alpha * alpha;
    const auto n = float(resolution);
    if (lobe == CacheLobe::equivalent) {
        // With 2n + 1 = 1 / alpha^2, Omega = 2 pi (2 alpha / (1 + alpha^2))^2.
        const float scaled = n * (2.0f * alpha / (1.0f + alpha2));
        return scaled > 1.0f ? std::min(fastLog2(scaled), fastLog2(n)) : 0.0f;
    }
    constexpr float kLog2Of100 = 6.6438562f;
    // 1 / n = 2 alpha^2 / (1 - alpha^2).
    const float cosine = alpha2 < 1.0f ? fastExp2(-kLog2Of100 * 2.0f * alpha2 / (1.0f - alpha2)) : 0.0f;
    const float texels = n * n * (1.0f - cosine);
    return texels > 1.0f ? 0.5f * fastLog2(texels) : 0.0f;
}

CachedLight evaluatePixel(const CacheWorld& world, bool specular, int x, int y)
{
    const std::size_t pixel = world.gbuffer.position.index(x, y);
    CachedLight light;
    Vec4 sum(0.0f);
    float weights = 0.0f;
    forCachesOf(world, x, y, [&](std::uint32_t cache, float weight) {
        sum += weight * diffuseOf(world, cache, world.gbuffer.normal.texels[pixel]);
        weights += weight;
        ++light.caches;
    });
    light.irradiance = Vec3(sum) / (weights * world.atlas.preExposure);
    light.opacity = sum.w / weights;
    if (specular && world.gbuffer.specularColor.texels[pixel] != Vec3(0.0f)) light.specular = specularOf(world, pixel, x, y);
    return light;
}

Gathered evaluateCaches(const CacheWorld& world, const Requirements& needs)
{
    const GBuffer& gbuffer = world.gbuffer;
    Gathered out = emptyGathered(gbuffer, needs);
    const ReadCounts counts = forTiles<ReadCounts>(gbuffer.width, gbuffer.height, [&] {
        return [&](int tileX, int tileY, ReadCounts& tile) {
            forPixels(gbuffer.width, gbuffer.height, tileX, tileY, [&](int x, int y) {
                const std::size_t pixel = out.irradiance.index(x, y);
                if (!gbuffer.covered(pixel)) return;
                const CachedLight light = evaluatePixel(world, needs.specular, x, y);
                out.irradiance.texels[pixel] = light.irradiance;
                out.opacity.texels[pixel] = light.opacity;
                if (needs.specular) out.specular.texels[pixel] = light.specular;
                ++tile.pixels;
                tile.caches += std::uint64_t(light.caches);
            });
        };
    });
    out.counters = {{"cached_pixels", static_cast<double>(counts.pixels)}, {"caches_read", static_cast<double>(counts.caches)}};
    return out;
}

}  // namespace lrsm
