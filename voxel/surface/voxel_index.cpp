#include "voxel/surface/voxel_index.h"

namespace lrsm {

VoxelIndex indexVoxels(const BitGrid& bits)
{
    VoxelIndex index;
    index.first.reserve(bits.bricks.size() + 1);
    std::uint32_t count = 0;
    for (const std::uint64_t brick : bits.bricks) {
        index.first.push_back(count);
        if (brick != 0) count += std::uint32_t(std::popcount(brick));
    }
    index.first.push_back(count);
    return index;
}

IVec3 voxelOf(const BitGrid& bits, std::size_t brick, int bit)
{
    const auto edge = std::size_t(BitGrid::bricksPerEdge(bits.grid.resolution));
    return {4 * int(brick % edge) + (bit & 3), 4 * int(brick / edge % edge) + ((bit >> 2) & 3), 4 * int(brick / (edge * edge)) + (bit >> 4)};
}

}  // namespace lrsm
