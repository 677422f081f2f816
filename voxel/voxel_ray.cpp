#include "voxel/voxel_ray.h"

namespace lrsm {
namespace {

/// Part of the ray inside the grid's cube.
struct RaySpan {
    float begin = 0.0f, end = 0.0f;
};

RaySpan clipToGrid(const Vec3& origin, const Vec3& direction, float start, float edge)
{
    RaySpan span{start, kInfinity};
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0f) {
            if (!(origin[axis] >= 0.0f && origin[axis] < edge)) return {};
            continue;
        }
        const float low = -origin[axis] / direction[axis], high = (edge - origin[axis]) / direction[axis];
        span.begin = std::max(span.begin, std::min(low, high));
        span.end = std::min(span.end, std::max(low, high));
    }
    return span;
}

/// The voxel that the ray is in, and how it goes on from there.
struct Walk {
    Vec3 origin, direction, inverse;  ///< inverse: 1 / direction
    float t = 0.0f;
    IVec3 cell{0};

    /// Leaves the block of `size` (a power of two) aligned voxels that holds the cell, through the face met first. Cells along the other axes
    /// follow from the place there, kept inside the block against rounding.
    void leaveBlock(int size)
    {
        const IVec3 low = cell & ~(size - 1);
        int axis = 0;
        float leave = kInfinity;
        for (int a = 0; a < 3; ++a) {
            if (direction[a] == 0.0f) continue;
            const int face = direction[a] > 0.0f ? low[a] + size : low[a];
            const float distance = (static_cast<float>(face) - origin[a]) * inverse[a];
            if (distance < leave) {
                leave = distance;
                axis = a;
            }
        }
        t = std::max(t, leave);
        if (size > 1) enterAt(low, low + (size - 1));
        cell[axis] = direction[axis] > 0.0f ? low[axis] + size : low[axis] - 1;
    }

    /// The voxel that holds the ray at t, within a box of voxels.
    void enterAt(const IVec3& low, const IVec3& high)
    {
        for (int a = 0; a < 3; ++a) cell[a] = std::clamp(static_cast<int>(std::floor(origin[a] + t * direction[a])), low[a], high[a]);
    }
};

/// Edge of an aligned block of voxels around an empty one that is known to be empty: at least 1.
int emptyBlock(const OpacityPyramid& opacity, const IVec3& cell)
{
    const std::size_t brick = opacity.base.brickIndex(cell.x, cell.y, cell.z);
    if (opacity.base.bricks[brick] != 0) return 1;
    const int levels = opacity.emptyLevels[brick];  // a level's lookup reads the texel that holds the point, among others
    return levels > 2 ? 1 << (levels - 1) : 4;
}

}  // namespace

std::optional<VoxelRun> firstOccupied(const OpacityPyramid& opacity, const Vec3& origin, const Vec3& direction, float start)
{
    const BitGrid& bits = opacity.base;
    const int n = bits.grid.resolution;
    const RaySpan span = clipToGrid(origin, direction, start, static_cast<float>(n));
    if (!(span.begin < span.end)) return {};

    Walk walk{origin, direction, 1.0f / direction, span.begin};
    walk.enterAt(IVec3(0), IVec3(n - 1));
    const auto inside = [&] { return glm::all(glm::greaterThanEqual(walk.cell, IVec3(0))) && glm::all(glm::lessThan(walk.cell, IVec3(n))); };
    const auto occupied = [&] { return bits.occupied(walk.cell.x, walk.cell.y, walk.cell.z); };
    for (; inside(); walk.leaveBlock(emptyBlock(opacity, walk.cell))) {
        if (!occupied()) continue;
        VoxelRun run{walk.t, walk.t};
        while (occupied()) walk.leaveBlock(1);
        run.leave = walk.t;
        return run;
    }
    return {};
}

}  // namespace lrsm
