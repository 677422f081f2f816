#include "voxel/cascades.h"

#include <cassert>
#include <cmath>
#include <utility>

namespace lrsm {

std::vector<VoxelGrid> cascadeGrids(const VoxelGrid& coarsest, int cascades, const Vec3& eye)
{
    assert(cascades == 1 || coarsest.resolution >= kLeastCascadeResolution);
    std::vector<VoxelGrid> grids(std::size_t(cascades), coarsest);
    for (int finer = 1; finer < cascades; ++finer) {
        VoxelGrid& grid = grids[std::size_t(cascades - 1 - finer)];
        const int edge = coarsest.resolution >> finer;  // in voxels of the coarsest
        grid.voxelSize = std::ldexp(coarsest.voxelSize, -finer);
        for (int axis = 0; axis < 3; ++axis) {
            const double corner = (double(eye[axis]) - double(coarsest.origin[axis])) / double(coarsest.voxelSize) - 0.5 * edge;
            const double snapped = std::floor(corner / kCascadeSnapVoxels + 0.5) * kCascadeSnapVoxels;
            const double inside = std::clamp(snapped, 0.0, double(coarsest.resolution - edge));
            grid.origin[axis] = float(double(coarsest.origin[axis]) + inside * double(coarsest.voxelSize));
        }
    }
    return grids;
}

void linkCascade(OpacityPyramid& finer, OpacityPyramid coarser)
{
    const VoxelGrid &own = finer.base.grid, &next = coarser.base.grid;
    assert(own.resolution == next.resolution && 2.0f * own.voxelSize == next.voxelSize);
    for (int axis = 0; axis < 3; ++axis)
        finer.coarserCorner[axis] = int(std::floor((double(next.origin[axis]) - double(own.origin[axis])) / double(own.voxelSize) + 0.5));
    finer.coarser.clear();
    finer.coarser.push_back(std::move(coarser));
}

VoxelBox outermostBox(const OpacityPyramid& pyramid)
{
    const OpacityPyramid* next = nextCascade(pyramid);
    if (!next) return {Vec3(0.0f), Vec3(float(pyramid.base.grid.resolution))};
    const VoxelBox box = outermostBox(*next);
    const Vec3 corner(pyramid.coarserCorner);
    return {corner + 2.0f * box.low, corner + 2.0f * box.high};
}

int outermostEdge(const OpacityPyramid& pyramid)
{
    const OpacityPyramid* next = nextCascade(pyramid);
    return next ? 2 * outermostEdge(*next) : pyramid.base.grid.resolution;
}

int cascadeOfReceiver(const OpacityPyramid& finest, const Vec3& pWorld, float threshold)
{
    int cascade = 0;
    for (const OpacityPyramid* pyramid = &finest; nextCascade(*pyramid); pyramid = nextCascade(*pyramid), ++cascade) {
        const VoxelGrid& grid = pyramid->base.grid;
        const Vec3 p = grid.voxelsFromWorld(pWorld) - Vec3(kReceiverInsideVoxels);
        if (cascadeShare(p, grid.resolution - 2 * int(kReceiverInsideVoxels), 0.0f) > threshold) break;
    }
    return cascade;
}

}  // namespace lrsm
