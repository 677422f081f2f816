#pragma once

#include "conetrace/frame/reduce.h"
#include "conetrace/proxies/lists.h"
#include "conetrace/proxies/vpl.h"
#include "conetrace/proxies/walk.h"

/// Light from the cells that a pixel's neighbours see: [P] Sec. 3.3, Eq. 5 to 7.
namespace lrsm {

/// Everything that a pixel reads.
struct GatherWorld {
    const GBuffer& gbuffer;  ///< of all pixels
    const Camera& camera;
    const ProxyCells& cells;
    const VisibilityLists& lists;
    const ProxySettings& settings;
    const VplSettings& vpl;
    const VplLobeIntegral* lobe = nullptr;  ///< read with pp_lobe_norm=lobe
    const WeighedProxies* seen = nullptr;   ///< read with pp_cell_weight=seen; none: each proxy counts once

    const CellLight& light(std::uint32_t cell) const { return seen ? seen->lights[cell] : cells.lights[cell]; }
};

// [P] gives no widths.
inline constexpr float kGeometricDepth = 0.05f;   ///< standard deviation of w_G in depth, of the pixel's own
inline constexpr float kGeometricNormal = 0.1f;   ///< ... in 1 - n.n
inline constexpr float kLeastListWeight = 1e-6f;  ///< of the four together, before they are made to sum to 1

/// The lists of the four blocks about a pixel, and w_G w_l of Eq. 5, made to sum to 1. Where no block has the pixel's geometry the one of the greatest w_l has
/// 1; where none of the four is covered, the nearest within kSearchedBlocks has, or all are 0.
struct ListWeights {
    std::array<std::size_t, 4> block{};
    std::array<float, 4> weight{};
};
inline constexpr int kSearchedBlocks = 4;
ListWeights listWeights(const GBuffer& gbuffer, int divisor, int x, int y);

/// visit(cell, weight, share) for the cells of the four lists, rising; the weight is the sum over the lists that hold the cell, the share that of the weights
/// times the part of each list's diffuse rays that met it. So sum_p w(p) L(V'_p) of Eq. 5 evaluates a cell once in place of up to four times.
template <class Visit>
void forListedCells(const VisibilityLists& lists, const ListWeights& weights, const Visit& visit)
{
    constexpr std::uint32_t kEnd = ~std::uint32_t(0);
    std::array<std::uint32_t, 4> at{}, end{};
    for (std::size_t k = 0; k < 4; ++k) {
        if (!(weights.weight[k] > 0.0f)) continue;
        at[k] = lists.first[weights.block[k]];
        end[k] = lists.first[weights.block[k] + 1];
    }
    for (;;) {
        std::uint32_t cell = kEnd;
        for (std::size_t k = 0; k < 4; ++k)
            if (at[k] < end[k]) cell = std::min(cell, lists.cells[at[k]]);
        if (cell == kEnd) return;
        float weight = 0.0f, share = 0.0f;
        for (std::size_t k = 0; k < 4; ++k)
            if (at[k] < end[k] && lists.cells[at[k]] == cell) {
                weight += weights.weight[k];
                share += weights.weight[k] * lists.share(weights.block[k], at[k]);
                ++at[k];
            }
        visit(cell, weight, share);
    }
}

/// A surface that is lit.
struct LitSurface {
    Vec3 position{0.0f}, normal{0.0f};
    Vec3 mirror{0.0f};  ///< unit; where the specular lobe looks, read by it alone
};

/// Is the cell nearer than R of Eq. 6, so that it shines proxy by proxy?
inline bool isNear(const GatherWorld& world, std::uint32_t cell, const Vec3& position)
{
    const Vec3 d = world.light(cell).centroid - position;
    const float reach = world.settings.range * world.cells.grid.diagonal();
    return glm::dot(d, d) < reach * reach;
}

/// A cell as a surface would see it with nothing between; with pp_cell_weight=seen each proxy as often as rays met it, so that only the quotient tells.
struct WholeCell {
    Vec3 irradiance{0.0f};    ///< f(v) of Eq. 6, W/m^2 times the pre-exposure
    float formFactor = 0.0f;  ///< F: the part of a cosine-weighted hemisphere's rays that its proxies, lit or not, would stop
};
/// By its proxies up to `end`, a quad: all of the cell's, or, where F is not asked for, litEnd alone; or by its spherical harmonics.
WholeCell cellByProxies(const ProxyCells& cells, const WeighedProxies* seen, std::uint32_t cell, std::uint32_t end, const LitSurface& surface,
                        const VplSettings& vpl);
WholeCell cellByHarmonics(const CellLight& light, const LitSurface& surface, const VplSettings& vpl);

/// What a cell gives of which a part is seen (pp_cell_weight=seen): V f(v), V = share / F, where `share` of the rays met it. What is hidden or missed counts as
/// what is seen, so that no light is lost or gained however few the rays or large the cells; as rays become many and the cells small it is the truth. Errors
/// that f and F have in common cancel. No more than share pi times the radiance of the cell's brightest proxy, which quotients of harmonics may exceed.
Vec3 irradianceOfSeen(const CellLight& light, const WholeCell& whole, float share);

/// What a listed cell gives, by pp_cell_weight. `weight` and `share` as of forListedCells.
Vec3 irradianceOfListed(const GatherWorld& world, std::uint32_t cell, const WholeCell& whole, float weight, float share);

/// Sums over solid angles: radiance by w W, and w W, for the weight w of Eq. 7 and the solid angle W = a cos' / (d^2 + r^2) of a proxy, lit or not, above the
/// surface's horizon. Their quotient is the mean radiance over the part of the lobe that sees proxies.
struct LobeSum {
    Vec3 radiance{0.0f};
    float weight = 0.0f;
};
LobeSum lobeByProxies(const ProxyCells& cells, const WeighedProxies* seen, std::uint32_t cell, const LitSurface& surface, const VplSettings& vpl,
                      const VplLobeWeight& lobe);
LobeSum lobeByHarmonics(const CellLight& light, float area, const LitSurface& surface, const VplSettings& vpl, const VplLobeWeight& lobe);

/// What one pixel takes.
struct ProxyPixel {
    Vec3 irradiance{0.0f}, specular{0.0f};
    float opacity = 0.0f;
    std::uint64_t cells = 0, proxies = 0;  ///< evaluated
};
ProxyPixel gatherProxyPixel(const GatherWorld& world, bool specular, int x, int y);

/// The pixels of `reduced`, in its order; parallel over tiles.
Gathered gatherFromCells(const GatherWorld& world, const ReducedGBuffer& reduced, const Requirements& needs);

}  // namespace lrsm
