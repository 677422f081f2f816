#pragma once

#include "voxel/bit_grid.h"

#include <cstdint>
#include <vector>

namespace lrsm {

/// OpacityPyramid::emptyLevels. A trilinear lookup at level l reads texels t - 1 .. t + 1 along each axis, t being the texel that holds
/// the point; where those hold no occupied voxel, the lookup is 0 at level l and at all finer ones.
std::vector<std::uint8_t> findEmptyLevels(const BitGrid& base);

}  // namespace lrsm
