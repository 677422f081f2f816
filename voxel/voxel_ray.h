#pragma once

#include "voxel/opacity_pyramid.h"

#include <optional>

namespace lrsm {

/// A run of occupied voxels along a ray: where the ray enters it and where it leaves it (or the grid), base voxels.
struct VoxelRun {
    float enter = 0.0f, leave = 0.0f;
};

/// The first run of occupied voxels along a ray, not before `start` (where it begins if that lies in one); nothing when the ray leaves the
/// grid unhindered. Origin and distances in base voxels from the grid's corner; `direction` unit. Voxels are visited one after the other
/// (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", Eurographics 1987), blocks known to be empty as a whole;
/// distances are computed afresh at each face, so that long rays do not drift.
std::optional<VoxelRun> firstOccupied(const OpacityPyramid& opacity, const Vec3& origin, const Vec3& direction, float start);

}  // namespace lrsm
