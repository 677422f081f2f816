#pragma once

#include "voxel/bit_grid.h"

#include <bit>
#include <cstdint>
#include <vector>

namespace lrsm {

/// Numbers the occupied voxels, brick by brick and bit by bit: what is known of surfaces lies in arrays of that order.
/// `first[brick]` is the number of its first voxel; the last entry counts all (fewer than 2^32).
struct VoxelIndex {
    std::vector<std::uint32_t> first;

    std::uint32_t count() const { return first.empty() ? 0 : first.back(); }
    /// The voxel must be occupied.
    std::uint32_t at(const BitGrid& bits, std::size_t brick, int bit) const
    {
        return first[brick] + std::uint32_t(std::popcount(bits.bricks[brick] & ((std::uint64_t(1) << bit) - 1)));
    }
    std::uint32_t at(const BitGrid& bits, const IVec3& voxel) const
    {
        return at(bits, bits.brickIndex(voxel.x, voxel.y, voxel.z), BitGrid::bitIndex(voxel.x, voxel.y, voxel.z));
    }
};

VoxelIndex indexVoxels(const BitGrid& bits);

/// Corner of voxel `bit` of a brick, in voxels.
IVec3 voxelOf(const BitGrid& bits, std::size_t brick, int bit);

/// visit(bit) for each bit of a brick's mask, lowest first.
template <class Visit>
void forEachBit(std::uint64_t mask, const Visit& visit)
{
    for (; mask != 0; mask &= mask - 1) visit(std::countr_zero(mask));
}

}  // namespace lrsm
