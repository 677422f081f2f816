#pragma once

#include "voxel/opacity_pyramid.h"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace lrsm {

/// Which lookups may find anything: made once a frame for the wide kernels, a bit a cell and level. A cell of a level is the lower texel of the 2x2x2 that a
/// trilinear lookup blends; a clear bit: no voxel is set below any of the eight. Level 0 asks level 1, whose 2x2x2 hold its own.
struct LookupCells {
    static constexpr int kFinest = 1;
    static constexpr int kWordBits = 32;

    std::array<std::int32_t, 32> firstBit{};  ///< of each level, whose rows along x begin with a word
    std::vector<std::int32_t> words;

    explicit LookupCells(const OpacityPyramid& pyramid);

    /// Of a level with n texels along an edge: binary logarithms of n and of the bits from one row to the next.
    static int edgeShift(int n) { return std::countr_zero(unsigned(n)); }
    static int rowShift(int n) { return std::countr_zero(unsigned(n < kWordBits ? kWordBits : n)); }
};

}  // namespace lrsm
