#include "voxel/opacity_pyramid.h"

#include "core/base/errors.h"
#include "core/base/formats.h"
#include "core/base/memory.h"
#include "voxel/empty_levels.h"
#include "voxel/pyramid_levels.h"

#include <cassert>
#include <new>
#include <string>
#include <utility>

namespace lrsm {
namespace {

struct Layout {
    std::vector<std::size_t> levelOffset;
    std::size_t texels = 0;
};

Layout layoutOf(int resolution)
{
    Layout layout;
    layout.levelOffset.push_back(0);
    for (int n = resolution / 2; n >= 1; n /= 2) {
        layout.levelOffset.push_back(layout.texels);
        layout.texels += std::size_t(n) * std::size_t(n) * std::size_t(n);
    }
    return layout;
}

std::size_t brickCount(int resolution)
{
    const auto edge = std::size_t(BitGrid::bricksPerEdge(resolution));
    return edge * edge * edge;
}

}  // namespace

float OpacityPyramid::value(int level, int axis, int x, int y, int z) const
{
    if (level == 0) return base.occupied(x, y, z) ? 1.0f : 0.0f;
    const std::size_t i = texelIndex(level, x, y, z) * std::size_t(channels()) + std::size_t(axis);
    return storage == Storage::gpu ? floatFromUnorm8(unorm8[i]) : float32[i];
}

float densityScale(const OpacityPyramid& pyramid, int level)
{
    if (pyramid.axes == OpacityAxes::isotropic) return 1.0f;
    return 1.0f / float(1 << std::min(level, 3));
}

OpacityPyramid buildPyramid(BitGrid base, const VoxelSettings& settings)
{
    assert(base.bricks.size() == brickCount(base.grid.resolution));
    OpacityPyramid pyramid;
    pyramid.base = std::move(base);
    pyramid.axes = settings.axes;
    pyramid.storage = settings.storage;
    pyramid.mipFilter = settings.mipFilter;
    Layout layout = layoutOf(pyramid.base.grid.resolution);
    pyramid.levelOffset = std::move(layout.levelOffset);

    requireMemory(predictPyramidBytes({.resolution = pyramid.base.grid.resolution, .axes = settings.axes, .storage = settings.storage}) - bytesOf(pyramid.base),
                  "opacity pyramid", "lower voxel_resolution");
    const std::size_t values = layout.texels * std::size_t(pyramid.channels());
    try {
        if (settings.storage == Storage::gpu)
            pyramid.unorm8.assign(values, 0);
        else
            pyramid.float32.assign(values, 0.0f);
    } catch (const std::bad_alloc&) {
        throw MachineError("opacity pyramid", "no memory for " + std::to_string(values) + " values; lower voxel.resolution");
    }

    if (pyramid.levels() > 1) fillLevelsFromBits(pyramid);
    const int firstFromBelow = settings.axes == OpacityAxes::directional ? 4 : 2;
    for (int level = firstFromBelow; level < pyramid.levels(); ++level) fillLevelFromBelow(pyramid, level);
    pyramid.emptyLevels = findEmptyLevels(pyramid.base);
    return pyramid;
}

std::size_t predictPyramidBytes(const VoxelSettings& settings)
{
    const std::size_t channels = settings.axes == OpacityAxes::directional ? 3 : 1;
    const std::size_t bytesPerValue = settings.storage == Storage::gpu ? 1 : sizeof(float);
    const std::size_t bricks = brickCount(settings.resolution);
    return bricks * sizeof(std::uint64_t) + layoutOf(settings.resolution).texels * channels * bytesPerValue + bricks;
}

std::size_t predictPyramidGpuBytes(const VoxelSettings& settings)
{
    const std::size_t n = std::size_t(settings.resolution);
    const std::size_t channels = settings.axes == OpacityAxes::directional ? 3 : 1;
    return n * n * n + layoutOf(settings.resolution).texels * channels;
}

}  // namespace lrsm
