#pragma once

#include "lrsm/layers.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lrsm {

/// An Lrsm as the wide kernels read it: made once a frame, beside the map.
struct MapView {
    static constexpr int kGroup = 8;  ///< layers that one byte answers for

    const Lrsm& lrsm;
    std::array<std::int32_t, 32> firstTexels{};  ///< of each level within a layer
    std::array<std::int32_t, 32> firstCells{};   ///< of each level within a group's cells

    /// Which layers may face a direction, by lookup: a cell is the lower texel, from (-1, -1) on, of the 2x2 that a lookup blends; its eight bytes are the
    /// octants of the direction (bit k of the octant's number: component k is negative), their bits the layers of a group. A clear bit: all normals in the 2x2
    /// texels, and in those of the next finer level below them, have n . d >= 0 for every direction d of the octant, hence so has any mean of them.
    std::vector<std::uint64_t> facing;
    std::size_t cellsPerGroup = 0;

    explicit MapView(const Lrsm& source);
    const std::uint8_t* facingOf(int group) const { return reinterpret_cast<const std::uint8_t*>(facing.data() + std::size_t(group) * cellsPerGroup); }
};

}  // namespace lrsm
