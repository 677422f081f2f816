#include "conetrace/ism/maps.h"

#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/base/rng.h"

#include <algorithm>
#include <numeric>

namespace lrsm {
namespace {

constexpr std::size_t kMapsPerTask = 8;
constexpr std::size_t kWindowStep = 7919;  // a prime: windows of neighbouring lights overlap little
constexpr std::uint32_t kOrderKey = 0x69736d70;

/// The fixed permutation: by a random number each.
std::vector<std::uint32_t> shuffled(std::size_t count)
{
    std::vector<std::uint64_t> keys(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto number = static_cast<std::uint32_t>(i);
        keys[i] = std::uint64_t(philox({number, 0, 0, 0}, {kOrderKey, 0})[0]) << 32 | number;
    }
    std::sort(keys.begin(), keys.end());
    return {keys.begin(), keys.end()};  // the numbers: low words
}

/// Does the disc of what a texel holds reach a place of the map?
bool reaches(const MapTexel& texel, float u, float v)
{
    const float du = texel.u - u, dv = texel.v - v;
    return texel.distance < kInfinity && du * du + dv * dv <= texel.reach * texel.reach;
}

/// Weighted mean of candidates within a window behind the nearest; empty where there are none.
struct MapBlend {
    MapTexel candidate[4];
    float weight[4];
    int count = 0;

    void offer(const MapTexel& texel, float by, float u, float v)
    {
        if (!reaches(texel, u, v)) return;
        candidate[count] = texel;
        weight[count++] = by;
    }
    MapTexel mean(float depthWindow) const
    {
        float nearest = kInfinity, total = 0.0f;
        for (int k = 0; k < count; ++k) nearest = std::min(nearest, candidate[k].distance);
        if (count == 0) return {};
        MapTexel sum{.distance = 0.0f};
        for (int k = 0; k < count; ++k) {
            const MapTexel& c = candidate[k];
            if (c.distance > nearest + depthWindow) continue;
            sum.distance += weight[k] * c.distance;
            sum.u += weight[k] * c.u;
            sum.v += weight[k] * c.v;
            sum.reach += weight[k] * c.reach;
            total += weight[k];
        }
        return {.distance = std::max(nearest, sum.distance / total), .u = sum.u / total, .v = sum.v / total, .reach = sum.reach / total};
    }
};

using MapLevels = std::vector<std::vector<MapTexel>>;

void pull(MapLevels& levels, int size, std::size_t level, float depthWindow)
{
    const std::vector<MapTexel>& from = levels[level - 1];
    const int n = size >> level, finer = 2 * n;
    const auto width = float(1 << level);
    levels[level].assign(std::size_t(n) * std::size_t(n), {});
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            MapBlend blend;
            for (int k = 0; k < 4; ++k)
                blend.offer(from[std::size_t((2 * row + k / 2) * finer + 2 * column + k % 2)], 1.0f, (float(column) + 0.5f) * width,
                            (float(row) + 0.5f) * width);
            levels[level][std::size_t(row * n + column)] = blend.mean(depthWindow);
        }
}

std::uint64_t push(MapLevels& levels, int size, std::size_t level, float depthWindow)
{
    const std::vector<MapTexel>& from = levels[level + 1];
    std::vector<MapTexel>& to = levels[level];
    const int n = size >> level, coarser = n / 2;
    const auto width = float(1 << level);
    std::uint64_t changed = 0;
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            // The parent, and its neighbours on this texel's side.
            const int right = (column & 1) != 0 ? 1 : -1, below = (row & 1) != 0 ? 1 : -1;
            MapBlend blend;
            for (int k = 0; k < 4; ++k) {
                const int i = column / 2 + (k % 2 != 0 ? right : 0), j = row / 2 + (k / 2 != 0 ? below : 0);
                if (i < 0 || j < 0 || i >= coarser || j >= coarser) continue;
                const float weight = (k % 2 != 0 ? 1.0f : 3.0f) * (k / 2 != 0 ? 1.0f : 3.0f);
                blend.offer(from[std::size_t(j * coarser + i)], weight, (float(column) + 0.5f) * width, (float(row) + 0.5f) * width);
            }
            const MapTexel above = blend.mean(depthWindow);
            MapTexel& own = to[std::size_t(row * n + column)];
            if (!(above.distance < kInfinity) || !(own.distance > above.distance + depthWindow)) continue;
            own = above;
            ++changed;
        }
    return changed;
}

}  // namespace

Counters countersOf(const ImperfectMaps& maps)
{
    return {{"points_drawn", double(maps.drawn)}, {"texels_filled", double(maps.filled)}};
}

std::vector<MapTexel> drawPoints(const VirtualLight& light, const PointProxies& points, std::span<const std::uint32_t> chosen, float pointRadius,
                                 float reachScale, int size, bool discs)
{
    std::vector<MapTexel> map(std::size_t(size) * std::size_t(size));
    const auto nearest = [&](int column, int row, const MapTexel& texel) {
        if (column < 0 || row < 0 || column >= size || row >= size) return;
        MapTexel& own = map[std::size_t(row * size + column)];
        if (texel.distance < own.distance) own = texel;
    };
    for (const std::uint32_t i : chosen) {
        const MapPlace place = placeInMap(light, points.positions[i], size);
        if (!(place.distance > kNearestPoint * pointRadius) || !(place.z > kLeastElevation)) continue;
        // A disc's radius in the map: its angle, by the paraboloid's scale 1 / (1 + z) there, as large as the disc looks from here.
        const Vec3 towards = (points.positions[i] - light.position) / place.distance;
        const float seen = std::sqrt(std::abs(glm::dot(points.normals[i], towards)));
        const MapTexel texel{.distance = place.distance,
                             .u = place.u,
                             .v = place.v,
                             .reach = reachScale * pointRadius * seen / place.distance * (0.5f * float(size)) / (1.0f + place.z)};
        nearest(static_cast<int>(place.u), static_cast<int>(place.v), texel);
        if (!discs) continue;
        const auto first = [&](float at) { return static_cast<int>(std::floor(std::max(0.0f, at - texel.reach))); };
        const auto last = [&](float at) { return static_cast<int>(std::min(float(size - 1), at + texel.reach)); };
        for (int row = first(texel.v); row <= last(texel.v); ++row)
            for (int column = first(texel.u); column <= last(texel.u); ++column)
                if (reaches(texel, float(column) + 0.5f, float(row) + 0.5f)) nearest(column, row, texel);
    }
    return map;
}

std::uint64_t pullPush(std::vector<MapTexel>& map, int size, float depthWindow)
{
    MapLevels levels = {std::move(map)};
    for (std::size_t level = 1; size >> level >= 1; ++level) {
        levels.emplace_back();
        pull(levels, size, level, depthWindow);
    }
    std::uint64_t changed = 0;
    for (std::size_t level = levels.size() - 1; level-- > 0;) changed = push(levels, size, level, depthWindow);
    map = std::move(levels.front());
    return changed;
}

ImperfectMaps renderMaps(const VirtualLights& lights, const PointProxies& points, const Aabb& reach, const Settings& settings)
{
    const IsmSettings& ism = settings.ism;
    const std::size_t drawn = std::min(std::size_t(ism.points), points.size());
    ImperfectMaps maps;
    maps.resolution = ism.resolution;
    maps.range = glm::length(reach.extent());
    maps.unorm = ism.storage == Storage::gpu;
    maps.pointRadius = drawn > 0 ? std::sqrt(points.area * (float(points.size()) / float(drawn)) / kPi) : 0.0f;
    requireMemory(lights.lights.size() * maps.texels() * sizeof(float), "imperfect shadow maps", "lower ism_lights or ism_resolution");
    maps.depth.assign(lights.lights.size() * maps.texels(), 1.0f);
    // Twice over, so that a window never wraps.
    std::vector<std::uint32_t> order = shuffled(points.size());
    order.insert(order.end(), order.begin(), order.begin() + static_cast<std::ptrdiff_t>(drawn));

    std::vector<std::uint64_t> filled(lights.lights.size(), 0);
    parallelFor(lights.lights.size(), kMapsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && drawn > 0; ++i) {
            const auto window = std::span(order).subspan(i * kWindowStep % points.size(), drawn);
            std::vector<MapTexel> map =
                drawPoints(lights.lights[i], points, window, maps.pointRadius, settings.proxies.radius, ism.resolution, ism.fill == IsmFill::splat);
            if (ism.fill == IsmFill::pullPush) filled[i] = pullPush(map, ism.resolution, 2.0f * maps.pointRadius);
            ConversionCounts counts;
            for (std::size_t t = 0; t < map.size(); ++t) {
                const float depth = std::min(1.0f, map[t].distance / maps.range);
                maps.depth[i * maps.texels() + t] = maps.unorm ? roundToUnorm16(depth, counts) : depth;
            }
        }
    });
    maps.drawn = drawn * lights.lights.size();
    maps.filled = std::accumulate(filled.begin(), filled.end(), std::uint64_t(0));
    return maps;
}

}  // namespace lrsm
