#include "conetrace/proxies/cells.h"

#include "core/base/memory.h"
#include "core/base/parallel.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr std::size_t kCellsPerTask = 64;
constexpr float kBoundsMargin = 1e-2f;          // of a disc's radius
constexpr int kUnlitBit = 32, kHashBit = 33;    // of a key: the proxy's number below
constexpr double kQuarter = 0.25, kHalf = 0.5;  // Eq. 3 of a Lambertian disc

struct Keyed {
    std::vector<std::uint64_t> keys;
    std::uint32_t hash(std::size_t i) const { return static_cast<std::uint32_t>(keys[i] >> kHashBit); }
    bool unlit(std::size_t i) const { return (keys[i] >> kUnlitBit & 1) != 0; }
    std::uint32_t number(std::size_t i) const { return static_cast<std::uint32_t>(keys[i]); }
};

Keyed sortedKeys(const CellGrid& grid, const PointProxies& proxies, const ProxyLight& light)
{
    Keyed sorted;
    sorted.keys.resize(proxies.size());
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        const std::uint64_t hash = grid.hash(grid.cellAt(proxies.positions[i])), unlit = light.radiance[i] == Vec3(0.0f) ? 1 : 0;
        sorted.keys[i] = hash << kHashBit | unlit << kUnlitBit | i;
    }
    std::sort(sorted.keys.begin(), sorted.keys.end());
    return sorted;
}

std::uint32_t quadsFor(std::size_t proxies)
{
    return static_cast<std::uint32_t>((proxies + 3) / 4);
}

/// Where in the sorted keys each cell's proxies stand, lit ones first.
struct CellRanges {
    std::vector<std::size_t> first, litEnd;
};
CellRanges rangesOf(const Keyed& sorted, std::size_t cells)
{
    CellRanges ranges{std::vector<std::size_t>(cells + 1), std::vector<std::size_t>(cells)};
    std::size_t at = 0;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        ranges.first[cell] = at;
        while (at < sorted.keys.size() && sorted.hash(at) == cell && !sorted.unlit(at)) ++at;
        ranges.litEnd[cell] = at;
        while (at < sorted.keys.size() && sorted.hash(at) == cell) ++at;
    }
    ranges.first[cells] = at;
    return ranges;
}

/// Proxies [begin, end) of the sorted keys into quads from `quad` on.
void fillQuads(const Keyed& sorted, const PointProxies& proxies, const ProxyLight& light, std::size_t begin, std::size_t end, std::uint32_t quad,
               ProxyCells& cells)
{
    for (std::size_t i = begin; i < end; ++i) {
        const std::size_t slot = std::size_t(quad) * 4 + (i - begin), lane = slot & 3;
        const std::uint32_t number = sorted.number(i);
        const Vec3 position = proxies.positions[number], normal = light.normals[number], radiance = light.radiance[number];
        ProxyQuad& to = cells.quads[slot / 4];
        to.x[lane] = position.x, to.y[lane] = position.y, to.z[lane] = position.z;
        to.nx[lane] = normal.x, to.ny[lane] = normal.y, to.nz[lane] = normal.z;
        to.red[lane] = radiance.x, to.green[lane] = radiance.y, to.blue[lane] = radiance.z;
        cells.numbers[slot] = number;
    }
}

/// A disc of radius r reaches r sqrt(1 - n_k^2) along axis k; a little more, so that no rounding of the test against the box loses a ray that meets the disc.
Aabb boundsOf(const Keyed& sorted, const PointProxies& proxies, float discRadius, std::size_t begin, std::size_t end)
{
    Aabb box;
    for (std::size_t i = begin; i < end; ++i) {
        const Vec3 position = proxies.positions[sorted.number(i)], normal = proxies.normals[sorted.number(i)];
        const Vec3 reach = discRadius * (glm::sqrt(glm::max(Vec3(0.0f), 1.0f - normal * normal)) + kBoundsMargin);
        box.include(position - reach);
        box.include(position + reach);
    }
    return box;
}

/// Eq. 2 and 3 over one cell, each proxy as often as `countOf(slot)` says.
template <class Count>
CellLight lightOf(const ProxyCells& cells, std::size_t cell, const Count& countOf)
{
    glm::dvec4 mean(0.0), along[3] = {glm::dvec4(0.0), glm::dvec4(0.0), glm::dvec4(0.0)};
    glm::dvec3 byFlux(0.0), all(0.0);
    double flux = 0.0, counted = 0.0;
    std::size_t lit = 0;
    Vec3 brightest(0.0f);
    for (std::size_t slot = std::size_t(cells.first[cell]) * 4; slot < std::size_t(cells.first[cell + 1]) * 4; ++slot) {
        const double count = cells.numbers[slot] == kNoProxy ? 0.0 : countOf(slot);
        if (count == 0.0) continue;
        const ProxyQuad& q = cells.quads[slot / 4];
        const std::size_t k = slot & 3;
        const glm::dvec3 position(double(q.x[k]), double(q.y[k]), double(q.z[k]));
        const Vec3 radiance(q.red[k], q.green[k], q.blue[k]);
        const glm::dvec4 strength = count * (glm::dvec4(glm::dvec3(radiance), 1.0) * double(cells.area));
        mean += kQuarter * strength;
        along[0] += kHalf * double(q.nx[k]) * strength;
        along[1] += kHalf * double(q.ny[k]) * strength;
        along[2] += kHalf * double(q.nz[k]) * strength;
        const double own = strength.x + strength.y + strength.z;
        byFlux += own * position;
        all += count * position;
        flux += own;
        counted += count;
        brightest = glm::max(brightest, radiance);
        if (slot < std::size_t(cells.litEnd[cell]) * 4) ++lit;
    }
    CellLight out{.mean = Vec4(mean), .along = {Vec4(along[0]), Vec4(along[1]), Vec4(along[2])}, .centroid = Vec3(0.0f)};
    if (counted > 0.0) out.centroid = Vec3(flux > 0.0 ? byFlux / flux : all / counted);
    out.litArea = cells.area * float(lit);
    out.brightest = brightest;
    return out;
}

}  // namespace

CellGrid makeCellGrid(const Aabb& reach, int cells)
{
    const float longest = reach.longestSide(), margin = 0.5f * kGridMargin * longest;
    CellGrid grid;
    if (!(longest > 0.0f)) return grid;
    grid.origin = reach.min - margin;
    grid.cellSize = (longest + 2.0f * margin) / float(cells);
    grid.size = glm::clamp(IVec3(glm::ceil((reach.extent() + 2.0f * margin) / grid.cellSize)), IVec3(1), IVec3(cells));
    return grid;
}

Counters countersOf(const ProxyCells& cells)
{
    return {{"occupied_cells", double(cells.occupied)},
            {.name = "quads", .value = double(cells.quads.size()), .describes = true},
            {.name = "cells", .value = double(cells.grid.count()), .describes = true}};
}

ProxyCells sortProxies(const Scene& scene, const PointProxies& proxies, const ProxyLight& light, const ProxySettings& settings)
{
    ProxyCells cells;
    cells.grid = makeCellGrid(extentOf(scene), settings.grid);
    cells.area = proxies.area;
    cells.radius = proxies.radius();
    cells.discRadius = settings.radius * cells.radius;
    cells.preExposure = light.preExposure;
    cells.half = light.half;

    // Sort, and count quads a cell.
    const std::size_t count = cells.grid.count();
    requireMemory(count * (sizeof(CellLight) + sizeof(Aabb) + 2 * sizeof(std::uint32_t)), "cells of proxies", "lower pp_grid");
    const Keyed sorted = sortedKeys(cells.grid, proxies, light);
    const CellRanges ranges = rangesOf(sorted, count);
    cells.first.resize(count + 1);
    cells.litEnd.resize(count);
    std::uint32_t quads = 0;
    for (std::size_t cell = 0; cell < count; ++cell) {
        cells.first[cell] = quads;
        quads += quadsFor(ranges.litEnd[cell] - ranges.first[cell]);
        cells.litEnd[cell] = quads;
        quads += quadsFor(ranges.first[cell + 1] - ranges.litEnd[cell]);
        cells.occupied += ranges.first[cell + 1] > ranges.first[cell] ? 1 : 0;
    }
    cells.first[count] = quads;

    // Write each cell's own.
    cells.quads.resize(quads);
    cells.numbers.assign(std::size_t(quads) * 4, kNoProxy);
    cells.lights.resize(count);
    cells.bounds.assign(count, {Vec3(0.0f), Vec3(0.0f)});
    parallelFor(count, kCellsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            const std::size_t from = ranges.first[cell], litEnd = ranges.litEnd[cell], to = ranges.first[cell + 1];
            if (from == to) continue;
            fillQuads(sorted, proxies, light, from, litEnd, cells.first[cell], cells);
            fillQuads(sorted, proxies, light, litEnd, to, cells.litEnd[cell], cells);
            cells.bounds[cell] = boundsOf(sorted, proxies, cells.discRadius, from, to);
            cells.lights[cell] = lightOf(cells, cell, [](std::size_t) { return 1.0; });
        }
    });
    return cells;
}

std::vector<Float4> countsOf(const std::vector<std::uint32_t>& hits)
{
    std::vector<Float4> counts(hits.size() / 4);
    for (std::size_t slot = 0; slot < hits.size(); ++slot) counts[slot / 4][slot & 3] = float(hits[slot]);
    return counts;
}

WeighedProxies weighProxies(const ProxyCells& cells, const std::vector<std::uint32_t>& hits)
{
    WeighedProxies seen{countsOf(hits), std::vector<CellLight>(cells.lights.size())};
    parallelFor(cells.lights.size(), kCellsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell) seen.lights[cell] = lightOf(cells, cell, [&](std::size_t slot) { return double(hits[slot]); });
    });
    return seen;
}

}  // namespace lrsm
