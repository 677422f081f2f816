#pragma once

#include "core/settings/settings.h"
#include "voxel/bit_grid.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lrsm {

/// Pre-filtered occupancy: level 0 is the bit grid, level l >= 1 holds (resolution >> l)^3 texels in [0, 1], down to 1x1x1, x-fastest.
///
/// OpacityAxes::isotropic, one value a texel. `mean`: mean of the 8 children (the paper, literally); `coverage`: their sum / 4, clamped:
/// keeps a one-voxel-thick wall opaque; `max`. Each level is made from the stored level below.
///
/// OpacityAxes::directional, three values a texel: area density along x, y and z. A block of 2^3, 4^3 or 8^3 voxels (levels 1-3) stores
/// the fraction of its columns along the axis that hold any occupied voxel, so a two-voxel-thick wall counts once. Per base voxel of depth
/// that is a density of fraction / 2^l: `densityScale` restores it. From level 4 on `mipFilter` combines the 8 children and the scale
/// stays 1/8.
///
/// UNORM8 levels hold the exact value, rounded half up (what the D3D rule gives for an exact input); float32 levels are summed over x
/// first, then y, then z.
struct OpacityPyramid {
    BitGrid base;
    OpacityAxes axes = OpacityAxes::isotropic;
    Storage storage = Storage::gpu;
    MipFilter mipFilter = MipFilter::mean;
    std::vector<std::size_t> levelOffset;  ///< in texels, of level l >= 1 (levelOffset[0] is 0 and unused)
    std::vector<std::uint8_t> unorm8;      ///< levels 1.. one after the other, channels() interleaved; storage == gpu
    std::vector<float> float32;            ///< the same; storage == float32

    /// For the sampler alone: per 4^3 brick, 1 + the highest level up to which every lookup centred in the brick is 0; 0 if none.
    std::vector<std::uint8_t> emptyLevels;

    /// The next cascade (voxel/cascades.h), or none: then this grid is all there is. Its corner, in this grid's voxels.
    std::vector<OpacityPyramid> coarser;
    IVec3 coarserCorner{0};

    int levels() const { return int(levelOffset.size()); }
    int channels() const { return axes == OpacityAxes::directional ? 3 : 1; }
    int resolutionAt(int level) const { return base.grid.resolution >> level; }
    std::size_t texelIndex(int level, int x, int y, int z) const
    {
        const auto n = std::size_t(resolutionAt(level));
        return levelOffset[std::size_t(level)] + (std::size_t(z) * n + std::size_t(y)) * n + std::size_t(x);
    }
    /// Stored value in [0, 1], decoded; level 0: the bit. `axis` 0 for isotropic. Coordinates inside the level.
    float value(int level, int axis, int x, int y, int z) const;
};

/// UNORM8 on a GPU, whatever is held here. Of one cascade: the next is another pass's output.
template <class Visit>
void forEachArray(const OpacityPyramid& pyramid, Visit&& visit)
{
    forEachArray(pyramid.base, visit);
    visit(pyramid.unorm8, ArrayTraits{pyramid.unorm8.size()});
    visit(pyramid.float32, ArrayTraits{pyramid.float32.size()});
    visit(pyramid.emptyLevels, ArrayTraits{0, false});
}

/// 1 for the isotropic pyramid and level 0; 2^-min(level, 3) for directional ones.
float densityScale(const OpacityPyramid& pyramid, int level);

OpacityPyramid buildPyramid(BitGrid base, const VoxelSettings& settings);

/// Exact bytes that buildPyramid's result will hold, without building it (spec: predicted equals measured).
std::size_t predictPyramidBytes(const VoxelSettings& settings);

/// The same occupancy as a GPU holds it (Table 1): R8 textures with the base level at one byte a voxel, `channels` bytes a texel above.
std::size_t predictPyramidGpuBytes(const VoxelSettings& settings);

/// Trilinear lookup at one level: texel centres at +0.5, border 0. pVoxels in base voxels. Isotropic: .x is the opacity, .y = .z = .x.
/// Directional: density per base voxel along each axis (level 0: the bit, three times).
/// These two choose among the pyramid's kinds at every call; a hot loop takes the sampler in sample_opacity.h, which they wrap.
Vec3 sampleLevel(const OpacityPyramid& pyramid, const Vec3& pVoxels, int level, FilterFraction fraction);

/// Quadrilinear, of all cascades: `level` in [0, levels - 1], clamped; exact at whole levels. Error, of what the stored texels say, <= kOpacityLookupMaxError.
inline constexpr float kOpacityLookupMaxError = 3e-7f;
Vec3 sampleOpacity(const OpacityPyramid& pyramid, const Vec3& pVoxels, float level, FilterFraction fraction);

}  // namespace lrsm
