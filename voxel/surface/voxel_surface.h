#pragma once

#include "core/scene/scene.h"
#include "core/settings/settings.h"
#include "voxel/bit_grid.h"
#include "voxel/surface/voxel_index.h"

namespace lrsm {

/// What an occupied voxel holds of surfaces: means over its fragments, the (triangle, voxel) pairs of `voxelize`. Each weighs by the area of the triangle
/// within the voxel, or 1 (vox_weight). Albedo and normal are the surface's (evaluateSurface) at the triangle's point nearest the voxel's centre, textures
/// filtered over a voxel's width.
struct VoxelSurfel {
    Vec3 albedo{0.0f};    ///< linear, [0, 1]
    Vec3 normal{0.0f};    ///< outward (front faces are counter-clockwise); length <= 1: the less, the more the fragments' normals differ
    Vec3 position{0.0f};  ///< mean of the points, in voxels from the voxel's corner
    float area = 0.0f;    ///< of all surfaces within the voxel, in faces of a voxel
};

/// A surfel an occupied voxel, in the order of `index`.
struct VoxelSurface {
    VoxelIndex index;
    std::vector<VoxelSurfel> surfels;

    /// Albedo RGBA8 and normal RGBA8_SNORM over the whole grid, as [CNS*11] stores them.
    static constexpr std::size_t kGpuVoxelBytes = 8;
    int resolution = 0;
};

template <class Visit>
void forEachArray(const VoxelSurface& surface, Visit&& visit)
{
    const auto n = static_cast<std::size_t>(surface.resolution);
    visit(surface.surfels, ArrayTraits{n * n * n * VoxelSurface::kGpuVoxelBytes});
    visit(surface.index.first, ArrayTraits{0, false});
}

/// Shorter than this the fragments' normals have cancelled: the surfel faces everywhere, <n.l> is kMeanCosine, the mean over the sphere's directions.
inline constexpr float kCancelledNormal = 0.125f, kMeanCosine = 0.25f;
inline bool normalCancels(const VoxelSurfel& surfel)
{
    return !(glm::length(surfel.normal) >= kCancelledNormal);
}

/// A fragment's weight is at least this part of a face: a triangle that only touches a voxel still says what is there.
inline constexpr double kLeastFragmentArea = 0x1p-12;

/// Sums are integers of 2^-20 units, added atomically: the same bits in any order. Each term rounds once, so a mean is within
/// kSurfaceSumError (fragments / total weight) of exact arithmetic.
inline constexpr double kSurfaceSumUnit = 0x1p-20, kSurfaceSumError = 0x1p-20;

/// `bits` are `voxelize(scene, settings)`.
VoxelSurface voxelSurface(const Scene& scene, const BitGrid& bits, const VoxelSettings& settings, TextureFilter textureFilter);

/// Area of a triangle (corners in voxels) within the voxel at `corner`, in faces of a voxel.
double areaInVoxel(const glm::dvec3 (&triangle)[3], const IVec3& corner);

}  // namespace lrsm
