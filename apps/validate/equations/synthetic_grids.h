#pragma once

#include "apps/validate/equations/worst_case.h"
#include "voxel/opacity_pyramid.h"

/// Voxel grids made of bits, for checks that need no scene.
namespace lrsm {

/// Asks occupied(x, y, z) for every voxel, x fastest.
template <class Occupied>
BitGrid gridOf(int n, Occupied&& occupied)
{
    BitGrid bits;
    bits.grid.resolution = n;
    const auto edge = std::size_t(BitGrid::bricksPerEdge(n));
    bits.bricks.assign(edge * edge * edge, 0);
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                if (occupied(x, y, z)) bits.bricks[bits.brickIndex(x, y, z)] |= std::uint64_t(1) << BitGrid::bitIndex(x, y, z);
    return bits;
}

inline BitGrid randomGrid(int n, double density, std::uint32_t stream)
{
    SearchRandom random(stream);
    return gridOf(n, [&](int, int, int) { return random.unit() < density; });
}

inline OpacityPyramid pyramidOf(BitGrid bits, OpacityAxes axes = OpacityAxes::directional, Storage storage = Storage::gpu, MipFilter filter = MipFilter::mean)
{
    VoxelSettings settings;
    settings.resolution = bits.grid.resolution;
    settings.axes = axes;
    settings.storage = storage;
    settings.mipFilter = filter;
    return buildPyramid(std::move(bits), settings);
}

}  // namespace lrsm
