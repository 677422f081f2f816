#pragma once

#include "conetrace/frame/gbuffer.h"
#include "conetrace/proxies/cells.h"
#include "conetrace/proxies/lists.h"

#include <cmath>

/// The Visibility Filter: [P] Sec. 3.2, Eq. 4.
namespace lrsm {

// [P] gives no thresholds.
inline constexpr float kFilterDepth = 0.05f;  ///< of the pixel's own depth: delta_d is 1 below
inline constexpr float kFilterCosine = 0.9f;  ///< between normals: delta_n is 1 above

/// delta_d delta_n of Eq. 4, for pixels of the G-buffer that are covered.
inline bool lendsVisibility(const GBuffer& g, std::size_t pixel, std::size_t neighbour)
{
    const float depth = g.depthLinear.texels[pixel];
    return std::abs(g.depthLinear.texels[neighbour] - depth) < kFilterDepth * depth &&
           glm::dot(g.normal.texels[pixel], g.normal.texels[neighbour]) > kFilterCosine;
}

/// With pp_filter_test=surface a block takes the list of another only if
/// - both are of one surface (frame/same_surface.h), which goes on from block to block along one of the window's shortest ways between them, through all
///   pixels: depth and normal are alike on both sides of a thin wall too;
/// - it is next to it, or nearer than this part of the harmonic mean distance R of what either's rays met, over which light changes little (Ward,
///   Rubinstein and Clear, "A Ray Tracing Solution for Diffuse Interreflection", SIGGRAPH 1988).
inline constexpr float kFilterReach = 0.15f;

/// 1/R of each block, 1/m: the mean over its diffuse rays of 1 / distance, to the centroid of the cell that a ray met, no nearer than a proxy's radius.
std::vector<float> nearnessOfBlocks(const VisibilityLists& lists, const GBuffer& gbuffer, const ProxyCells& cells);

/// V'_p(x, y): the union of V_p(x + i, y + j) over |i|, |j| <= pp_filter_radius of the blocks that lend theirs; hits and rays are summed. Opacities stay the
/// pixel's own.
VisibilityLists filterVisibility(const VisibilityLists& lists, const GBuffer& gbuffer, const ProxyCells& cells, const ProxySettings& settings);

}  // namespace lrsm
