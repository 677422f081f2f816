#pragma once

#include "core/scene/scene.h"
#include "core/settings/settings.h"
#include "voxel/bit_grid.h"
#include "voxel/fixed_triangle.h"

#include <functional>

namespace lrsm {

/// The grid of a scene: about its reach, or all of it (settings.extent).
VoxelGrid gridOf(const Scene& scene, const VoxelSettings& settings);
/// That one, and finer ones about the eye (settings.cascades), finest first: cascadeGrids.
std::vector<VoxelGrid> gridsOf(const Scene& scene, const VoxelSettings& settings, const Vec3& eye);

/// Scene -> binary occupancy (Sec. 3.2). `conservative`: exactly the voxels whose closed box the closed triangle overlaps (26-separating);
/// `thin`: Schwarz and Seidel 2010's 6-separating test, a subset; `raster`: projection along the dominant axis sampled at pixel centres,
/// what [CG12] does without conservative rasterization (it has holes).
/// Triangles with a non-finite vertex are dropped, and those no wider than the rounding of their corners (no area). Independent of thread count.
/// With an alpha mask in the scene the whole triangle is solid, as a GPU voxelizer that does not sample textures would have it; unless its mesh is drawn
/// nowhere.
BitGrid voxelize(const Scene& scene, const VoxelSettings& settings);
BitGrid voxelize(const Scene& scene, const VoxelGrid& grid, Voxelization mode);  ///< in a grid that covers as much as it does

/// Of one triangle: voxels of one brick that it sets, as `voxelize` would.
struct BrickFragments {
    std::uint32_t mesh, triangle;
    const FixedTriangle& piece;  ///< the triangle, or the part of it that a huge one was cut to
    std::size_t brick;
    std::uint64_t voxels;  ///< bits as in BitGrid
};
/// Every (triangle, voxel) pair of `voxelize`, each once; in parallel and in no order.
void forEachFragment(const Scene& scene, const VoxelGrid& grid, Voxelization mode, const std::function<void(const BrickFragments&)>& visit);

/// The same for one bare triangle list in world space: what tests drive. Triangles of no area voxelize as the segment or point they are.
BitGrid voxelizeTriangles(const std::vector<Vec3>& corners, const VoxelGrid& grid, Voxelization mode);

}  // namespace lrsm
