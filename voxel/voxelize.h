#pragma once

#include "core/scene/scene.h"
#include "core/settings/settings.h"
#include "voxel/bit_grid.h"
#include "voxel/fixed_triangle.h"

#include <functional>
#include <string>
#include <vector>

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

/// What the voxels of one moment leave for the next: those of the meshes that stand.
struct StandingVoxels {
    VoxelGrid grid;                   ///< of the last moment
    std::vector<std::string> meshes;  ///< the last moment's, by key
    std::vector<bool> standing;       ///< one a mesh: in `bits`
    BitGrid bits;                     ///< empty while nothing both stands and is passed by something that moves
};

/// The same bits as `voxelize`: of the meshes that the last moments had too only a copy, the others into it. `keys`: one a mesh, equal only where the mesh is
/// the same to the bit (keysOf); materials and settings must be those of the last moment.
BitGrid voxelizeAfter(StandingVoxels& last, const Scene& scene, const std::vector<std::string>& keys, const VoxelGrid& grid, Voxelization mode);

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
