#include "reference/light_pool.h"

namespace lrsm {
namespace {

void append(std::vector<float>& x, std::vector<float>& y, std::vector<float>& z, const Vec3& v)
{
    x.push_back(v.x);
    y.push_back(v.y);
    z.push_back(v.z);
}

void reserve(LightPool& pool, std::size_t count)
{
    for (std::vector<float>* stream :
         {&pool.x, &pool.y, &pool.z, &pool.gx, &pool.gy, &pool.gz, &pool.nx, &pool.ny, &pool.nz, &pool.density, &pool.brightness})
        stream->reserve(count);
    pool.points.reserve(count);
}

}  // namespace

bool seenAlike(const Vec3& geometricNormal, const Vec3& normal, const Vec3& toViewer)
{
    return glm::dot(normal, toViewer) >= kLeastFacing && glm::dot(normal, geometricNormal) >= kLeastFacing;
}

LightPool drawPool(Tracer& tracer, std::span<const LightMap> maps, const LightDensity& density, const SobolBlock& points, std::uint32_t first,
                   std::uint32_t count)
{
    LightPool pool;
    pool.drawn = count;
    reserve(pool, count);
    for (std::uint32_t i = first; i < first + count; ++i) {
        // The ray
        const LightPoint drawn = density.draw(points.point(i));
        const LightMap& map = maps[drawn.light];
        const std::optional<Ray> ray = map.ray(drawn.at, tracer.lightOffset(drawn.light));
        if (!ray) continue;
        const std::optional<RayHit> hit = tracer.closestHit(*ray);
        if (!hit) continue;

        // What it strikes, lit as technique a finds it
        const Surface surface = evaluateSurface(tracer.scene(), hit->surface, -ray->direction);
        const LightSample light = tracer.lights()[drawn.light](surface.position);
        const float cosine = glm::dot(surface.geometricNormal, light.toLight);
        const Vec3 radiance = diffuseRadiance(surface, light);
        const float brightness = radiance.x + radiance.y + radiance.z;
        if (!(cosine > 0.0f && brightness > 0.0f) || !(glm::dot(surface.normal, surface.geometricNormal) >= kLeastFacing)) continue;
        if (!tracer.lit(surface.position, surface.geometricNormal, light)) continue;

        // The density there; of the point, not of the draw, so that both techniques know the same
        const std::optional<LightCoordinates> at = map.coordinates(surface.position);
        if (!at) continue;
        const auto perArea = float(double(density({drawn.light, at->at})) * at->perArea * double(cosine));
        if (!(perArea > 0.0f) || !std::isfinite(perArea)) continue;
        append(pool.x, pool.y, pool.z, surface.position);
        append(pool.gx, pool.gy, pool.gz, surface.geometricNormal);
        append(pool.nx, pool.ny, pool.nz, surface.normal);
        pool.density.push_back(perArea);
        pool.brightness.push_back(brightness);
        pool.points.push_back({hit->surface, radiance, drawn.light});
    }
    return pool;
}

}  // namespace lrsm
