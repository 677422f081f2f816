#pragma once

#include "core/base/settings.h"
#include "voxel/bit_grid.h"

#include <span>

namespace lrsm {

/// Pre-filtered occupancy: level 0 is the bit grid, level l >= 1 holds (resolution >> l)^3 values in [0, 1], down to 1x1x1, x-fastest.
/// `mean`: mean of the 8 children (the paper, literally); `coverage`: their sum / 4, clamped; `max`. Each level is made from the stored level
/// below in float32 in a fixed order, then converted (`storage`: UNORM8 or float32).
///
/// With OpacityAxes::directional there are three such chains: area density along x, y and z. A block of 2^3, 4^3 or 8^3 voxels holds the
/// fraction of its columns along the axis that hold any occupied voxel, divided by the block's edge in voxels and multiplied by it again as
/// density per base voxel: levels 1-3 = popcount(OR along the axis) / 4^l / 2^l; above that the mean. A two-voxel-thick wall counts once.
/// Stored scaled by 2^min(l,3) so that UNORM8 keeps its precision; `densityScale(level)` undoes it.
struct OpacityPyramid {
    BitGrid base;
    OpacityAxes axes = OpacityAxes::isotropic;
    Storage storage = Storage::gpu;
    MipFilter mipFilter = MipFilter::mean;
    std::vector<std::size_t> levelOffset;    ///< of level l >= 1 in each chain (levelOffset[0] is unused)
    std::vector<std::uint8_t> unorm8[3];     ///< [0] isotropic, or x, y, z; storage == gpu
    std::vector<float> float32[3];           ///< storage == float32

    int levels() const { return int(levelOffset.size()); }
    int resolutionAt(int level) const { return base.frame.resolution >> level; }
    std::size_t byteSize() const;
};

/// 1 for the isotropic pyramid and level 0; 2^-min(level, 3) for directional chains.
float densityScale(const OpacityPyramid& pyramid, int level);

OpacityPyramid buildPyramid(BitGrid base, const VoxelSettings& settings);

/// Exact bytes that buildPyramid's result will hold, without building it (spec: predicted equals measured).
std::size_t predictPyramidBytes(const VoxelSettings& settings);

/// Trilinear lookup at one level: texel centres at +0.5, border 0. pVoxels in base voxels. Isotropic: .x is the opacity, .y = .z = .x.
/// Directional: density per base voxel along each axis (level 0: the bit, three times).
Vec3 sampleLevel(const OpacityPyramid& pyramid, const Vec3& pVoxels, int level, FilterFraction fraction);

/// Quadrilinear: `level` in [0, levels - 1], clamped; exact at whole levels.
Vec3 sampleOpacity(const OpacityPyramid& pyramid, const Vec3& pVoxels, float level, FilterFraction fraction);

}  // namespace lrsm
