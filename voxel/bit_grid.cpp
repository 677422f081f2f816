#include "voxel/bit_grid.h"

#include "core/base/errors.h"
#include "core/base/parallel.h"

#include <bit>
#include <string>

namespace lrsm {

VoxelGrid fitVoxelGrid(const Aabb& bounds, int resolution)
{
    if (resolution < 1 || resolution > 2048 || (resolution & (resolution - 1)) != 0)
        throw InputError("voxel.resolution", std::to_string(resolution) + " is not a power of two in 1..2048");

    // A scene without extent (nothing, one point) still gets a grid: a cube of one metre.
    const bool hasPlace = !bounds.empty();
    const Vec3 low = hasPlace ? bounds.min : Vec3(0.0f);
    const Vec3 high = hasPlace ? bounds.max : Vec3(0.0f);
    if (!isFinite(low) || !isFinite(high)) throw InputError("voxel grid", "the scene's bounds are not finite; remove the infinite vertices");

    // In double: the extent of a finite box may overflow a float.
    double longest = 0.0;
    for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, double(high[axis]) - double(low[axis]));
    if (longest == 0.0) longest = 1.0;
    const double margin = std::min(2.0, resolution / 4.0);

    VoxelGrid grid;
    grid.resolution = resolution;
    grid.voxelSize = float(longest / (resolution - 2.0 * margin));
    if (!std::isnormal(grid.voxelSize))
        throw InputError("voxel grid", "the scene's longest side is " + std::to_string(longest) + " m; scale it to fit float32");
    const double halfEdge = 0.5 * double(grid.voxelSize) * resolution;
    for (int axis = 0; axis < 3; ++axis) {
        grid.origin[axis] = float(0.5 * (double(low[axis]) + double(high[axis])) - halfEdge);
        if (!std::isfinite(grid.origin[axis])) throw InputError("voxel grid", "the grid would reach beyond float32; scale the scene down");
    }
    return grid;
}

std::uint64_t BitGrid::countOccupied() const
{
    constexpr std::size_t grain = std::size_t(1) << 16;
    std::vector<std::uint64_t> partial((bricks.size() + grain - 1) / grain, 0);
    parallelFor(bricks.size(), grain, [&](std::size_t begin, std::size_t end) {
        std::uint64_t sum = 0;
        for (std::size_t i = begin; i < end; ++i)
            if (bricks[i] != 0) sum += std::uint64_t(std::popcount(bricks[i]));
        partial[begin / grain] = sum;
    });
    std::uint64_t total = 0;
    for (const std::uint64_t sum : partial) total += sum;
    return total;
}

}  // namespace lrsm
