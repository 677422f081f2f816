#include "reference/light_pool.h"

#include <algorithm>

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
    for (std::vector<float>* stream : {&pool.x, &pool.y, &pool.z, &pool.gx, &pool.gy, &pool.gz, &pool.nx, &pool.ny, &pool.nz, &pool.density, &pool.brightness})
        stream->reserve(count);
    pool.points.reserve(count);
}

/// A lit point on its way into the pool.
struct Found {
    std::uint64_t order = 0;  ///< along the lights' squares, see hilbertIndex
    float density = 0.0f;
    LightPool::Point point;
};

/// How far along Hilbert's curve, which keeps neighbours together, a point of the unit square lies: the square's quarters are run through in a U that turns
/// from level to level (Warren, "Hacker's Delight", 2012, 16).
std::uint32_t hilbertIndex(UnitPoint at)
{
    constexpr int bits = 16;
    auto x = std::uint32_t(at.u * float(1 << bits)), y = std::uint32_t(at.v * float(1 << bits)), index = 0u;
    for (std::uint32_t half = 1u << (bits - 1); half > 0; half >>= 1) {
        const bool right = x & half, up = y & half;
        index = index << 2 | (right ? 3u ^ std::uint32_t(up) : std::uint32_t(up));
        if (!up) {
            if (right) {
                x = ~x;
                y = ~y;
            }
            std::swap(x, y);
        }
    }
    return index;
}

/// What one ray of a light strikes, lit as technique a finds it.
std::optional<Found> follow(Tracer& tracer, std::span<const LightMap> maps, const TileGuide& guide, const LightPoint& drawn, Transport transport)
{
    const LightMap& map = maps[drawn.light];
    const std::optional<Ray> ray = map.ray(drawn.at, tracer.lightOffset(drawn.light));
    if (!ray) return std::nullopt;
    const std::optional<RayHit> hit = tracer.closestHit(*ray);
    if (!hit) return std::nullopt;

    const Surface surface = evaluateSurface(tracer.scene(), hit->surface, -ray->direction);
    const LightSample light = tracer.lights()[drawn.light](surface.position);
    const float cosine = glm::dot(surface.geometricNormal, light.toLight);
    const bool glossy = transport == Transport::full && surface.specularColor != Vec3(0.0f) && glm::dot(surface.normal, light.toLight) > 0.0f;
    if (!(cosine > 0.0f) || light.irradiance == Vec3(0.0f) || (!glossy && diffuseRadiance(surface, light) == Vec3(0.0f)) ||
        !(glm::dot(surface.normal, surface.geometricNormal) >= kLeastFacing))
        return std::nullopt;
    if (!tracer.lit(surface.position, surface.geometricNormal, light)) return std::nullopt;

    // The density is that of the point, not of the draw, so that both techniques know the same.
    const std::optional<LightCoordinates> at = map.coordinates(surface.position);
    if (!at) return std::nullopt;
    const LightPoint point{drawn.light, at->at};
    const auto perArea = float(double(guide.density(point)) * at->perArea * double(cosine));
    if (!(perArea > 0.0f) || !std::isfinite(perArea)) return std::nullopt;
    const float reach = guide.reach.empty() ? 1.0f : guide.reach[guide.density.grids().texelOf(point)];
    return Found{std::uint64_t(drawn.light) << 32 | hilbertIndex(at->at), perArea, {hit->surface, surface, light, drawn.light, reach, glossy}};
}

}  // namespace

bool seenAlike(const Vec3& geometricNormal, const Vec3& normal, const Vec3& toViewer)
{
    return glm::dot(normal, toViewer) >= kLeastFacing && glm::dot(normal, geometricNormal) >= kLeastFacing;
}

LightPool drawPool(Tracer& tracer, std::span<const LightMap> maps, const TileGuide& guide, const SobolBlock& points, std::uint32_t first, std::uint32_t count,
                   Transport transport)
{
    std::vector<Found> found;
    found.reserve(count);
    for (std::uint32_t i = first; i < first + count; ++i)
        if (std::optional<Found> one = follow(tracer, maps, guide, guide.density.draw(points.point(i)), transport)) found.push_back(*one);
    // Neighbours side by side: draws that are stratified along the pool are stratified over what is lit.
    std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.order < b.order; });

    LightPool pool;
    pool.drawn = count;
    pool.transport = transport;
    reserve(pool, found.size());
    for (const Found& one : found) {
        const LightPool::Point& point = one.point;
        append(pool.x, pool.y, pool.z, point.surface.position);
        append(pool.gx, pool.gy, pool.gz, point.surface.geometricNormal);
        append(pool.nx, pool.ny, pool.nz, point.surface.normal);
        pool.density.push_back(one.density);
        const Vec3 diffuse = diffuseRadiance(point.surface, point.sample);
        pool.brightness.push_back(point.reach * (diffuse.x + diffuse.y + diffuse.z));
        if (point.glossy) pool.glossy.push_back(std::uint32_t(pool.points.size()));
        pool.points.push_back(one.point);
    }
    return pool;
}

}  // namespace lrsm
