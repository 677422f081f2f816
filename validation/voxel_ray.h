#pragma once

#include "voxel/bit_grid.h"

#include <optional>

namespace lrsm {

/// Distance at which a ray first lies in an occupied voxel, not before `start` (which counts if it lies in one itself); nothing when it leaves the
/// grid unhindered. Origin and distances in base voxels from the grid's corner; `direction` unit. Voxels are visited one after the other
/// (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987), empty bricks as a whole; distances are
/// computed afresh at each face, so that long rays do not drift.
std::optional<float> firstOccupied(const BitGrid& grid, const Vec3& origin, const Vec3& direction, float start);

}  // namespace lrsm
