#pragma once

#include "conetrace/proxies/lit.h"
#include "core/base/simd.h"

/// Proxies hashed into the cells of a grid, and what each cell shines from afar: [P] Sec. 3.1, Eq. 1 to 3.
namespace lrsm {

/// Cubes over the scene's reach.
struct CellGrid {
    Vec3 origin{0.0f};      ///< least corner, world
    float cellSize = 1.0f;  ///< m
    IVec3 size{1};          ///< cells along each axis: D of Eq. 1

    std::size_t count() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
    /// Eq. 1: H(v) = v.z D_x D_y + v.y D_x + v.x.
    std::uint32_t hash(const IVec3& v) const
    {
        return (static_cast<std::uint32_t>(v.z) * static_cast<std::uint32_t>(size.y) + static_cast<std::uint32_t>(v.y)) * static_cast<std::uint32_t>(size.x) +
               static_cast<std::uint32_t>(v.x);
    }
    /// In cells from the origin.
    Vec3 cellsFromWorld(const Vec3& p) const { return (p - origin) / cellSize; }
    /// Of the cell that holds p; the nearest where p is outside.
    IVec3 cellAt(const Vec3& p) const { return glm::clamp(IVec3(glm::floor(cellsFromWorld(p))), IVec3(0), size - 1); }
    float diagonal() const { return 1.7320508f * cellSize; }
};

/// `cells` of them along the longest side; a hair wider, so that no surface of the reach's own box lies on its border.
CellGrid makeCellGrid(const Aabb& reach, int cells);
inline constexpr float kGridMargin = 1e-4f;  ///< of the longest side, in all

/// Four proxies, as kernels take them. Where a cell's do not fill the last one, its normal and radiance are 0: no ray meets it, and it lights nothing.
struct ProxyQuad {
    Float4 x{}, y{}, z{};           ///< position, world
    Float4 nx{}, ny{}, nz{};        ///< geometric normal, unit, of the side that shines
    Float4 red{}, green{}, blue{};  ///< radiance times the pre-exposure
};
inline constexpr std::uint32_t kNoProxy = ~std::uint32_t(0);

/// A cell's intensity I_v towards w, Eq. 2 cut after l = 1: mean + along . w, red, green, blue, and area, the intensity of all its proxies at radiance 1.
/// Eq. 3 for I_p(w) = L a max(0, n.w), with y_00 = 1/(2 sqrt pi) and y_1 = sqrt(3/(4 pi)) w: c_00 y_00 = L a / 4, c_1m y_1m = L a n.w / 2.
struct CellLight {
    Vec4 mean{0.0f};
    Vec4 along[3]{Vec4(0.0f), Vec4(0.0f), Vec4(0.0f)};  ///< x, y, z
    Vec3 centroid{0.0f};                                ///< of its proxies by flux; where none shines, of all
    float litArea = 0.0f;                               ///< m^2, of those that shine
    Vec3 brightest{0.0f};                               ///< greatest radiance of one of them, a channel; times the pre-exposure

    /// W/sr times the pre-exposure; a sum that falls below 0 is none.
    Vec4 intensity(const Vec3& w) const { return glm::max(Vec4(0.0f), mean + along[0] * w.x + along[1] * w.y + along[2] * w.z); }
};

/// Sorted by (H, unlit, number): quads first[h] .. litEnd[h] - 1 of cell h shine, those up to first[h + 1] only occlude.
struct ProxyCells {
    CellGrid grid;
    float area = 0.0f;        ///< of a proxy, m^2
    float radius = 0.0f;      ///< of a disc as large, m
    float discRadius = 0.0f;  ///< of the disc that stops rays, m
    float preExposure = 1.0f;
    bool half = true;
    std::vector<std::uint32_t> first, litEnd;
    std::vector<ProxyQuad> quads;
    std::vector<std::uint32_t> numbers;  ///< of each quad's four, as placed; kNoProxy where there is none
    std::vector<CellLight> lights;
    std::vector<Aabb> bounds;    ///< of the discs of each cell, wherever these reach; 0 where there are none
    std::uint64_t occupied = 0;  ///< cells
};

template <class Visit>
void forEachArray(const ProxyCells& cells, Visit&& visit)
{
    // A proxy on a GPU: position in float32, normal in 10 bits a component, radiance. A cell: 16 coefficients, centroid, area and brightest in float32.
    constexpr std::size_t kPositionNormal = 16, kHalf4 = 8, kFloat4 = 16;
    visit(cells.first, ArrayTraits{cells.first.size() * sizeof(std::uint32_t)});
    visit(cells.litEnd, ArrayTraits{cells.litEnd.size() * sizeof(std::uint32_t)});
    visit(cells.quads, ArrayTraits{cells.quads.size() * 4 * (kPositionNormal + (cells.half ? kHalf4 : kFloat4))});
    visit(cells.numbers, ArrayTraits{0});
    visit(cells.lights, ArrayTraits{cells.lights.size() * sizeof(CellLight)});
    visit(cells.bounds, ArrayTraits{cells.bounds.size() * sizeof(Aabb)});
}

Counters countersOf(const ProxyCells& cells);

/// Sums of a cell are made in double, in the order of its proxies.
ProxyCells sortProxies(const Scene& scene, const PointProxies& proxies, const ProxyLight& light, const ProxySettings& settings);

/// How much each proxy counts in the mean radiance of its cell (pp_cell_weight=seen): as often as the frame's rays met it. So what is hidden from all, layers
/// behind what is seen, counts nothing, and what is open counts more than what hardly is; both are of another brightness as a rule.
struct WeighedProxies {
    std::vector<Float4> counts;     ///< of each quad's four; exact up to 2^24
    std::vector<CellLight> lights;  ///< of each cell, of proxies that many times
};
template <class Visit>
void forEachArray(const WeighedProxies& seen, Visit&& visit)
{
    visit(seen.counts, ArrayTraits{seen.counts.size() * sizeof(Float4)});
    visit(seen.lights, ArrayTraits{seen.lights.size() * sizeof(CellLight)});
}
inline Counters countersOf(const WeighedProxies&)
{
    return {};
}
std::vector<Float4> countsOf(const std::vector<std::uint32_t>& hits);
/// `hits`: of each slot of ProxyCells::numbers.
WeighedProxies weighProxies(const ProxyCells& cells, const std::vector<std::uint32_t>& hits);

}  // namespace lrsm
