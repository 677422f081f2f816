#include "voxel/radiance/octree_bytes.h"

#include "voxel/radiance/radiance_volume.h"

namespace lrsm {
namespace {

constexpr std::size_t kLeafBytes = 16, kInnerBytes = 52, kNodeBytes = 36, kBrickBytes = 27 * 16;

/// Occupancy of 2^3 blocks, as bits again.
BitGrid halved(const BitGrid& bits)
{
    BitGrid half;
    half.grid.resolution = bits.grid.resolution / 2;
    half.bricks.assign(predictBitGridBytes(half.grid.resolution) / sizeof(std::uint64_t), 0);
    const int n = bits.grid.resolution;
    for (int z = 0; z < n; z += 4)
        for (int y = 0; y < n; y += 4)
            for (int x = 0; x < n; x += 4) {
                const std::uint64_t brick = bits.bricks[bits.brickIndex(x, y, z)];
                if (brick == 0) continue;
                for (int k = 0; k < 64; ++k)
                    if ((brick >> k) & 1u) {
                        const int hx = (x + (k & 3)) / 2, hy = (y + ((k >> 2) & 3)) / 2, hz = (z + (k >> 4)) / 2;
                        half.bricks[half.brickIndex(hx, hy, hz)] |= std::uint64_t(1) << BitGrid::bitIndex(hx, hy, hz);
                    }
            }
    return half;
}

}  // namespace

std::vector<std::size_t> countOccupiedTexels(const BitGrid& bits)
{
    std::vector<std::size_t> counts{bits.countOccupied()};
    BitGrid level;
    const BitGrid* below = &bits;
    while (below->grid.resolution > 1) {
        level = halved(*below);
        below = &level;
        counts.push_back(level.countOccupied());
    }
    return counts;
}

OctreeBytes octreeBytes(const std::vector<std::size_t>& occupied, int resolution)
{
    OctreeBytes bytes;
    bytes.dense = RadianceVolume::predictGpuBytes(resolution);
    bytes.occupiedOnly = occupied[0] * kLeafBytes;
    std::size_t nodes = 1;  // the root
    for (std::size_t level = 1; level < occupied.size(); ++level) {
        bytes.occupiedOnly += occupied[level] * kInnerBytes;
        if (level >= 2) nodes += 8 * occupied[level];  // the nodes of level - 1
    }
    bytes.tilesOfEight = nodes * kInnerBytes + (occupied.size() > 1 ? 8 * occupied[1] * kLeafBytes : 0);
    bytes.bricks = nodes * (kNodeBytes + kBrickBytes);
    return bytes;
}

}  // namespace lrsm
