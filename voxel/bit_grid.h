#pragma once

#include "core/base/arrays.h"
#include "core/base/counters.h"
#include "core/base/math.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lrsm {

/// Where the voxels are: a cube of resolution^3 cubic voxels; voxel (x, y, z) spans origin + voxelSize * [x, x + 1] ...
struct VoxelGrid {
    Vec3 origin{0.0f};       ///< world position of the corner of voxel (0, 0, 0)
    float voxelSize = 1.0f;  ///< metres
    int resolution = 1;

    Vec3 voxelsFromWorld(const Vec3& pWorld) const { return (pWorld - origin) / voxelSize; }
    bool operator==(const VoxelGrid&) const = default;
};

/// Cube centred on `bounds`: the longest side plus a margin of two voxels at either end (less where the resolution is below 8).
VoxelGrid fitVoxelGrid(const Aabb& bounds, int resolution);

/// Distance, in base voxels, at which a ray leaves a box (0 if it never meets it).
inline float boxExit(const Vec3& originVoxels, const Vec3& direction, const Vec3& low, const Vec3& high)
{
    float exit = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0f) continue;
        const float wall = direction[axis] > 0.0f ? high[axis] : low[axis];
        exit = std::min(exit, (wall - originVoxels[axis]) / direction[axis]);
    }
    return std::max(exit, 0.0f);
}
/// The same of the grid's cube.
inline float gridExit(const Vec3& originVoxels, const Vec3& direction, int resolution)
{
    return boxExit(originVoxels, direction, Vec3(0.0f), Vec3(static_cast<float>(resolution)));
}

/// Binary occupancy, one bit a voxel, in bricks of 4x4x4: bit (x&3) + 4 (y&3) + 16 (z&3) of word brick(x/4, y/4, z/4), bricks x-fastest.
/// Resolutions below 4 use part of one brick.
struct BitGrid {
    VoxelGrid grid;
    std::vector<std::uint64_t> bricks;

    static int bricksPerEdge(int resolution) { return (resolution + 3) / 4; }
    std::size_t brickIndex(int x, int y, int z) const
    {
        const auto n = std::size_t(bricksPerEdge(grid.resolution));
        return (std::size_t(z >> 2) * n + std::size_t(y >> 2)) * n + std::size_t(x >> 2);
    }
    static int bitIndex(int x, int y, int z) { return (x & 3) | ((y & 3) << 2) | ((z & 3) << 4); }
    /// False outside the grid (border 0).
    bool occupied(int x, int y, int z) const
    {
        const auto n = unsigned(grid.resolution);
        if (unsigned(x) >= n || unsigned(y) >= n || unsigned(z) >= n) return false;
        return (bricks[brickIndex(x, y, z)] >> bitIndex(x, y, z)) & 1u;
    }
    std::uint64_t countOccupied() const;
};

inline std::size_t predictBitGridBytes(int resolution)
{
    const auto n = static_cast<std::size_t>(BitGrid::bricksPerEdge(resolution));
    return n * n * n * sizeof(std::uint64_t);
}

/// A GPU has no 1-bit format: one byte a voxel (Sec. 5).
inline std::size_t predictBitGridGpuBytes(int resolution)
{
    const auto n = static_cast<std::size_t>(resolution);
    return n * n * n;
}

template <class Visit>
void forEachArray(const BitGrid& bits, Visit&& visit)
{
    visit(bits.bricks, ArrayTraits{predictBitGridGpuBytes(bits.grid.resolution)});
}

inline Counters countersOf(const BitGrid& bits)
{
    return {{"voxels_set", static_cast<double>(bits.countOccupied())}};
}

}  // namespace lrsm
