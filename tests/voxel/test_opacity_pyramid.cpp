// Every level is held against columns and means counted in double in apps/validate/equations/voxel_checks.cpp.
#include "voxel/opacity_pyramid.h"

#include "apps/validate/equations/synthetic_grids.h"
#include "core/base/parallel.h"

#include "catch.h"

using namespace lrsm;

TEST_CASE("a wall keeps its opacity across it: directional and coverage, the mean of the paper halves at each level", "[voxel][pyramid]")
{
    const int n = 32;
    const BitGrid wall = gridOf(n, [](int x, int, int) { return x == 16 || x == 17; });
    const OpacityPyramid directional = pyramidOf(wall, OpacityAxes::directional, Storage::float32),
                         mean = pyramidOf(wall, OpacityAxes::isotropic, Storage::float32),
                         coverage = pyramidOf(wall, OpacityAxes::isotropic, Storage::float32, MipFilter::coverage);
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
    const BitGrid bits = randomGrid(128, 0.01, 9);
    OpacityPyramid serial;
    {
        const ThreadLimit one(1);
        serial = buildPyramid(bits, settings);
    }
    const ThreadLimit eight(8);
    const OpacityPyramid parallel = buildPyramid(bits, settings);
    CHECK(serial.unorm8 == parallel.unorm8);
    CHECK(serial.emptyLevels == parallel.emptyLevels);
    CHECK(bits.countOccupied() == parallel.base.countOccupied());
}

TEST_CASE("countOccupied counts every voxel once", "[voxel]")
{
    const BitGrid bits = randomGrid(64, 0.3, 4);
    std::uint64_t count = 0;
    for (int z = 0; z < 64; ++z)
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) count += bits.occupied(x, y, z);
    CHECK(bits.countOccupied() == count);
    CHECK_FALSE(bits.occupied(-1, 0, 0));
    CHECK_FALSE(bits.occupied(0, 64, 0));
}
