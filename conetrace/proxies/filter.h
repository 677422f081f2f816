#pragma once

#include "conetrace/frame/gbuffer.h"
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

/// V'_p(x, y): the union of V_p(x + i, y + j) over |i|, |j| <= radius where delta_d delta_n = 1. Opacities stay the pixel's own.
VisibilityLists filterVisibility(const VisibilityLists& lists, const GBuffer& gbuffer, int radius, std::size_t cells);

}  // namespace lrsm
