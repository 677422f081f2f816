#include "reference/light_pool.h"

#include <algorithm>

namespace lrsm {
namespace {

std::array<std::vector<float>*, 11> streamsOf(LightPool& pool)
{
    return {&pool.x, &pool.y, &pool.z, &pool.gx, &pool.gy, &pool.gz, &pool.nx, &pool.ny, &pool.nz, &pool.density, &pool.brightness};
}

/// A lit point on its way into the pool.
struct Found {
    std::uint64_t order = 0;  ///< along the lights' squares, see hilbertIndex
    LightPool::Point point;
};

/// How far along Hilbert's curve, which keeps neighbours together, a point of the unit square lies: the square's quarters are run through in a U that turns
/// from level to level (Warren, "Hacker's Delight", 2012, 16).
std::uint32_t hilbertIndex(UnitPoint at)
{
    constexpr int bits = 16;
    auto x = std::uint32_t(at.u * float(1 << bits)), y = std::uint32_t(at.v * float(1 << bits)), index = 0u;
    for (int level = bits - 1; level >= 0; --level) {  // without branches: they would be guessed wrong
        const std::uint32_t right = x >> level & 1u, up = y >> level & 1u;
        index = index << 2 | (3u * right ^ up);
        const std::uint32_t turned = 0u - (right & (up ^ 1u)), swapped = (x ^ y) & (up - 1u);
        x ^= swapped ^ turned;
        y ^= swapped ^ turned;
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
    const std::size_t texel = guide.density.grids().texelOf({drawn.light, at->at});
    const auto perArea = float(double(guide.density.inTexel(texel)) * at->perArea * double(cosine));
    if (!(perArea > 0.0f) || !std::isfinite(perArea)) return std::nullopt;
    const float reach = guide.reach.empty() ? 1.0f : guide.reach[texel];
    const Vec3 diffuse = diffuseRadiance(surface, light);
    return Found{std::uint64_t(drawn.light) << 32 | hilbertIndex(at->at),
                 {surface, perArea, reach * (diffuse.x + diffuse.y + diffuse.z), reach, glossy, diffuse, drawn.light, hit->surface, light}};
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
    std::vector<std::pair<std::uint64_t, std::size_t>> order(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) order[i] = {found[i].order, i};
    std::sort(order.begin(), order.end());

    LightPool pool;
    pool.drawn = count;
    pool.transport = transport;
    pool.points.reserve(found.size());
    for (const auto& [along, i] : order) {
        const LightPool::Point& point = found[i].point;
        if (point.glossy) pool.glossy.push_back(std::uint32_t(pool.points.size()));
        pool.points.push_back(point);
    }
    layOut(pool, 1);
    return pool;
}

void layOut(LightPool& pool, std::size_t subsets)
{
    pool.subsets = subsets;
    const std::size_t slots = pool.slotsASubset();
    for (std::vector<float>* stream : streamsOf(pool)) stream->assign(subsets * slots, 0.0f);
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const LightPool::Point& point = pool.points[i];
        const Surface& surface = point.surface;
        const std::size_t slot = i % subsets * slots + i / subsets;
        const auto store = [slot](std::vector<float>& x, std::vector<float>& y, std::vector<float>& z, const Vec3& v) {
            x[slot] = v.x;
            y[slot] = v.y;
            z[slot] = v.z;
        };
        store(pool.x, pool.y, pool.z, surface.position);
        store(pool.gx, pool.gy, pool.gz, surface.geometricNormal);
        store(pool.nx, pool.ny, pool.nz, surface.normal);
        pool.density[slot] = point.density;
        pool.brightness[slot] = point.brightness;
    }
}

}  // namespace lrsm
