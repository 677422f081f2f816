#include "voxel/opacity_pyramid.h"

#include "catch.h"
#include "core/base/formats.h"
#include "core/base/parallel.h"

#include <random>

using namespace lrsm;

namespace {

BitGrid randomGrid(int n, double density, unsigned seed)
{
    BitGrid grid;
    grid.frame.resolution = n;
    const auto edge = std::size_t(BitGrid::bricksPerEdge(n));
    grid.bricks.assign(edge * edge * edge, 0);
    std::mt19937 random(seed);
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                if (double(random()) * 0x1p-32 < density) grid.bricks[grid.brickIndex(x, y, z)] |= std::uint64_t(1) << BitGrid::bitIndex(x, y, z);
    return grid;
}

double stored(double exact, Storage storage)
{
    if (storage == Storage::gpu) return double(floatFromUnorm8(std::uint8_t(std::floor(exact * 255.0 + 0.5))));
    return exact;
}

/// Fraction of the (2^l)^2 columns along `axis` of a block that hold an occupied voxel.
double columnFraction(const BitGrid& grid, int level, int axis, const IVec3& block)
{
    const int n = 1 << level;
    int hit = 0;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            bool any = false;
            for (int k = 0; k < n; ++k) {
                IVec3 p = block * n;
                p[axis] += k;
                p[(axis + 1) % 3] += i;
                p[(axis + 2) % 3] += j;
                any = any || grid.occupied(p.x, p.y, p.z);
            }
            hit += any;
        }
    }
    return double(hit) / (n * n);
}

double expectedTexel(const OpacityPyramid& pyramid, int level, int axis, const IVec3& p)
{
    if (pyramid.axes == OpacityAxes::directional && level <= 3) return stored(columnFraction(pyramid.base, level, axis, p), pyramid.storage);
    // UNORM8: sum the codes, which a double holds exactly.
    const double unit = pyramid.storage == Storage::gpu && level > 1 ? 255.0 : 1.0;
    double sum = 0.0, largest = 0.0;
    for (int k = 0; k < 8; ++k) {
        const float child = pyramid.value(level - 1, axis, 2 * p.x + (k & 1), 2 * p.y + ((k >> 1) & 1), 2 * p.z + (k >> 2));
        const double code = unit == 1.0 ? double(child) : std::round(double(child) * unit);
        sum += code;
        largest = std::max(largest, code);
    }
    const double filtered = pyramid.mipFilter == MipFilter::mean ? sum / 8.0 : pyramid.mipFilter == MipFilter::max ? largest : std::min(unit, sum / 4.0);
    if (unit == 1.0) return stored(filtered, pyramid.storage);
    return double(floatFromUnorm8(std::uint8_t(std::floor(filtered + 0.5))));
}

}  // namespace

TEST_CASE("each level equals a brute-force recomputation in double, after rounding", "[voxel][pyramid]")
{
    const auto axes = GENERATE(OpacityAxes::isotropic, OpacityAxes::directional);
    const auto storage = GENERATE(Storage::gpu, Storage::float32);
    const auto filter = GENERATE(MipFilter::mean, MipFilter::coverage, MipFilter::max);
    for (const int n : {1, 2, 4, 8, 32}) {
        for (const double density : {0.0, 0.003, 0.1, 0.6, 1.0}) {
            VoxelSettings settings;
            settings.resolution = n;
            settings.axes = axes;
            settings.storage = storage;
            settings.mipFilter = filter;
            const OpacityPyramid pyramid = buildPyramid(randomGrid(n, density, unsigned(n)), settings);
            REQUIRE(pyramid.levels() == 1 + int(std::log2(n)));
            REQUIRE(pyramid.resolutionAt(pyramid.levels() - 1) == 1);
            int wrong = 0;
            for (int level = 1; level < pyramid.levels(); ++level)
                for (int z = 0; z < n >> level; ++z)
                    for (int y = 0; y < n >> level; ++y)
                        for (int x = 0; x < n >> level; ++x)
                            for (int axis = 0; axis < pyramid.channels(); ++axis)
                                wrong += double(pyramid.value(level, axis, x, y, z)) != expectedTexel(pyramid, level, axis, IVec3(x, y, z));
            INFO(n << "^3, density " << density);
            REQUIRE(wrong == 0);
        }
    }
}

TEST_CASE("a wall keeps its opacity across it: directional and coverage; the mean of the paper halves at each level", "[voxel][pyramid]")
{
    const int n = 32;
    BitGrid wall = randomGrid(n, 0.0, 1);
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (const int x : {16, 17}) wall.bricks[wall.brickIndex(x, y, z)] |= std::uint64_t(1) << BitGrid::bitIndex(x, y, z);
    VoxelSettings settings;
    settings.resolution = n;
    settings.storage = Storage::float32;
    settings.axes = OpacityAxes::directional;
    const OpacityPyramid directional = buildPyramid(wall, settings);
    settings.axes = OpacityAxes::isotropic;
    const OpacityPyramid mean = buildPyramid(wall, settings);
    settings.mipFilter = MipFilter::coverage;
    const OpacityPyramid coverage = buildPyramid(wall, settings);
    for (int level = 1; level <= 4; ++level) {
        const int x = 16 >> level;
        INFO("level " << level);
        // Two voxels thick, but one wall: density times depth is 1 in each block up to 8^3.
        if (level <= 3) CHECK(directional.value(level, 0, x, 0, 0) * densityScale(directional, level) * float(1 << level) == 1.0f);
        CHECK(directional.value(level, 1, x, 0, 0) == (level <= 3 ? std::ldexp(1.0f, 1 - level) : 0.125f));
        CHECK(mean.value(level, 0, x, 0, 0) == std::ldexp(1.0f, 1 - level));
        CHECK(coverage.value(level, 0, x, 0, 0) == 1.0f);
    }
    CHECK(densityScale(directional, 0) == 1.0f);
    CHECK(densityScale(directional, 4) == 0.125f);
    CHECK(densityScale(mean, 4) == 1.0f);
}

TEST_CASE("predicted bytes are the bytes held", "[voxel][pyramid][memory]")
{
    const int n = GENERATE(1, 2, 4, 16, 128);
    for (const auto axes : {OpacityAxes::isotropic, OpacityAxes::directional}) {
        for (const auto storage : {Storage::gpu, Storage::float32}) {
            VoxelSettings settings;
            settings.resolution = n;
            settings.axes = axes;
            settings.storage = storage;
            CHECK(bytesOf(buildPyramid(randomGrid(n, 0.1, 1), settings)) == predictPyramidBytes(settings));
        }
    }
}

TEST_CASE("256^3 and 512^3 take what Table 1's formats give", "[voxel][memory]")
{
    VoxelSettings settings;
    settings.axes = OpacityAxes::isotropic;
    settings.resolution = 256;
    CHECK(double(predictPyramidGpuBytes(settings)) == Approx(19.2e6).epsilon(0.002));  // Table 2
    CHECK(double(predictPyramidBytes(settings)) == Approx(4.76e6).epsilon(0.002));
    settings.resolution = 512;
    CHECK(double(predictPyramidGpuBytes(settings)) == Approx(153.4e6).epsilon(0.001));  // Table 2 prints 156.4
    CHECK(double(predictPyramidBytes(settings)) == Approx(38.0e6).epsilon(0.002));
    settings.resolution = 2048;
    CHECK(predictPyramidBytes(settings) > std::size_t(1) << 31);
}

TEST_CASE("pyramids do not depend on the number of threads", "[voxel][pyramid][determinism]")
{
    VoxelSettings settings;
    settings.resolution = 128;
    settings.axes = GENERATE(OpacityAxes::isotropic, OpacityAxes::directional);
    const BitGrid grid = randomGrid(128, 0.01, 9);
    OpacityPyramid serial;
    {
        const ThreadLimit one(1);
        serial = buildPyramid(grid, settings);
    }
    const ThreadLimit eight(8);
    const OpacityPyramid parallel = buildPyramid(grid, settings);
    CHECK(serial.unorm8 == parallel.unorm8);
    CHECK(serial.emptyLevels == parallel.emptyLevels);
    CHECK(grid.countOccupied() == parallel.base.countOccupied());
}

TEST_CASE("countOccupied counts every voxel once", "[voxel]")
{
    const BitGrid grid = randomGrid(64, 0.3, 4);
    std::uint64_t count = 0;
    for (int z = 0; z < 64; ++z)
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) count += grid.occupied(x, y, z);
    CHECK(grid.countOccupied() == count);
    CHECK_FALSE(grid.occupied(-1, 0, 0));
    CHECK_FALSE(grid.occupied(0, 64, 0));
}
