#pragma once

#include "lrsm/rsm.h"

/// The surface behind a texel of a reflective shadow map.
namespace lrsm {

/// World, of a covered texel's centre.
Vec3 texelPosition(const Rsm& rsm, std::size_t texel);

/// Surface that it stands for, m^2: r^2 dw / <n.l>.
float texelArea(const Rsm& rsm, std::size_t texel);
inline constexpr float kLeastTexelCosine = 1e-3f;  ///< texels at more of a slant count as wide as at this one

}  // namespace lrsm
