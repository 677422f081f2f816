#pragma once

#include "core/base/math.h"
#include "voxel/bit_grid.h"

#include <array>
#include <cstdint>

namespace lrsm {

/// Vertices are rounded to 1/4096 voxel before any overlap is decided (displacement at most 1/8192 voxel). From there on the voxelizer
/// computes in integers alone, so it is exact, and a wall that is meant to lie on a voxel boundary does lie on it.
inline constexpr int kVoxelFractionBits = 12;

/// vertex[k][axis] in 1/4096 voxel from the grid's corner, |coordinate| <= 2^24: 4096 voxels.
struct FixedTriangle {
    std::array<std::array<std::int32_t, 3>, 3> vertex;
};

inline constexpr int kMaxPieces = 14;

struct FixedPieces {
    std::array<FixedTriangle, kMaxPieces> piece;
    int count = 0;
};

/// World -> fixed point. A triangle with a non-finite vertex yields nothing; one that reaches beyond 4096 voxels is first cut to the grid
/// plus one voxel around it, in double (the only inexact step; no scene that fits its frame takes it).
FixedPieces fixedFromWorld(const Vec3& a, const Vec3& b, const Vec3& c, const VoxelGrid& grid);

}  // namespace lrsm
