#pragma once

#include "voxel/opacity_pyramid.h"
#include "voxel/sampling_vectors.h"

#include <algorithm>
#include <vector>

/// Nested grids, where one cannot be both fine and wide (the paper's future work; Crassin and Green 2012 have them as clipmaps): each has as many voxels as the
/// last, half as wide. OpacityPyramid::coarser links them, finest first; all that is said in base voxels is then in those of the pyramid that one starts from.
namespace lrsm {

/// The grid of a scene, and `cascades - 1` finer ones about the eye, as far as they fit in it, finest first. Their corners lie on every kCascadeSnapVoxels-th
/// voxel of the coarsest, so that voxels stay where they are while the eye moves: a finer grid jumps, the bits where old and new one overlap are the same.
/// `coarsest.resolution` >= kLeastCascadeResolution where there are several.
std::vector<VoxelGrid> cascadeGrids(const VoxelGrid& coarsest, int cascades, const Vec3& eye);
inline constexpr int kCascadeSnapVoxels = 8;

/// Makes `coarser` the next cascade of `finer`: twice as wide, its voxels on the same lattice.
void linkCascade(OpacityPyramid& finer, OpacityPyramid coarser);

inline const OpacityPyramid* nextCascade(const OpacityPyramid& pyramid)
{
    return pyramid.coarser.empty() ? nullptr : &pyramid.coarser.front();
}

inline const OpacityPyramid& cascadeAt(const OpacityPyramid& finest, int cascade)
{
    return cascade == 0 ? finest : cascadeAt(*nextCascade(finest), cascade - 1);
}

/// The cube of the coarsest cascade, in base voxels of the one given.
struct VoxelBox {
    Vec3 low{0.0f}, high{0.0f};
};
VoxelBox outermostBox(const OpacityPyramid& pyramid);

/// What a cascade covers along an edge with all coarser ones: the coarsest grid's edge, in base voxels of the one given.
int outermostEdge(const OpacityPyramid& pyramid);

/// A place in base voxels of a cascade, and the level of a lookup there, for the next.
inline Vec3 toCoarser(const OpacityPyramid& pyramid, const Vec3& pVoxels)
{
    return (pVoxels - Vec3(pyramid.coarserCorner)) * 0.5f;
}
inline float levelInCoarser(float level)
{
    return std::max(level - 1.0f, 0.0f);
}

/// A wall that covers a base voxel covers half of one twice as thick: what the next cascade's texels say, in densities of this one's. Values of mip_filter
/// coverage and max do not depend on a voxel's thickness.
inline float densityOfCoarser(const OpacityPyramid& pyramid)
{
    return pyramid.axes == OpacityAxes::directional || pyramid.mipFilter == MipFilter::mean ? 0.5f : 1.0f;
}

/// Over as many voxels inside a grid's border lookups go from it to the next one.
inline constexpr float kCascadeBlendVoxels = 4.0f;

/// Share of a lookup that a grid answers: 0 where a texel is missing of those that are blended, 1 where all are kCascadeBlendVoxels inside.
inline float cascadeShare(const Vec3& pVoxels, int resolution, float level)
{
    const int lower = int(level), coarsest = lower + (level > float(lower));
    const Vec3 toBorder = glm::min(pVoxels, Vec3(float(resolution)) - pVoxels);
    const float inside = std::min(std::min(toBorder.x, toBorder.y), toBorder.z) - 0.5f / sampling::inversePower(coarsest);
    return std::clamp(inside * (1.0f / kCascadeBlendVoxels), 0.0f, 1.0f);
}

/// visit(pyramid, pVoxels, level, factor) for each cascade that answers the lookup, finest first: its value, times factor, adds. One grid is visited once, its
/// factor 1.
template <class Visit>
void forCascades(const OpacityPyramid& finest, Vec3 pVoxels, float level, const Visit& visit)
{
    level = level > 0.0f ? level : 0.0f;
    float left = 1.0f;
    for (const OpacityPyramid* pyramid = &finest;; pyramid = nextCascade(*pyramid)) {
        const float share = nextCascade(*pyramid) ? cascadeShare(pVoxels, pyramid->base.grid.resolution, level) : 1.0f;
        if (share > 0.0f) visit(*pyramid, pVoxels, level, left * share);
        if (share == 1.0f) return;
        left = (left - left * share) * densityOfCoarser(*pyramid);
        pVoxels = toCoarser(*pyramid, pVoxels);
        level = levelInCoarser(level);
    }
}

/// What a lookup of voxels `width` wide takes for them, in base voxels: a cascade's own may be wider. Both are means by the cascades' shares.
struct TapSize {
    float width = 1.0f;  ///< of the texels
    float voxel = 1.0f;  ///< of the cascade's voxels
};
inline TapSize tapSizeAt(const OpacityPyramid& finest, Vec3 pVoxels, float level, float width)
{
    if (!nextCascade(finest)) return {width, 1.0f};
    TapSize size{0.0f, 0.0f};
    float left = 1.0f, voxel = 1.0f;
    for (const OpacityPyramid* pyramid = &finest; pyramid; pyramid = nextCascade(*pyramid), voxel *= 2.0f) {
        const float factor = nextCascade(*pyramid) ? left * cascadeShare(pVoxels, pyramid->base.grid.resolution, level) : left;
        size.width += factor * std::max(width, voxel);
        size.voxel += factor * voxel;
        left -= factor;
        pVoxels = toCoarser(*pyramid, pVoxels);
        level = levelInCoarser(level);
    }
    return size;
}

/// Which cascade (0: the first) the cones of a receiver count in: the finest that holds it kReceiverInsideVoxels from its border, what a cone meets before
/// it widens; over kCascadeBlendVoxels more only where its share is above `threshold`, in [0, 1): receivers of a pattern of thresholds blend.
int cascadeOfReceiver(const OpacityPyramid& finest, const Vec3& pWorld, float threshold);
inline constexpr float kReceiverInsideVoxels = 8.0f;

}  // namespace lrsm
