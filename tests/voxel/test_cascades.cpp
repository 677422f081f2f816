#include "voxel/cascades.h"

#include "apps/validate/equations/synthetic_grids.h"
#include "core/scene/builtin_scenes.h"
#include "voxel/sample_opacity.h"
#include "voxel/voxelize.h"

#include "catch.h"

#include <cstring>

using namespace lrsm;

namespace {

/// Voxel sizes and corners that float32 holds exactly.
constexpr VoxelGrid kCoarsestOfThree = {Vec3(-4.0f), 0.125f, 64};

/// Pyramids on these grids, linked, with `occupied(grid, x, y, z)`.
template <class Occupied>
OpacityPyramid linkedGrids(const std::vector<VoxelGrid>& grids, const VoxelSettings& kind, const Occupied& occupied)
{
    OpacityPyramid all;
    for (std::size_t i = grids.size(); i-- > 0;) {
        BitGrid bits = gridOf(grids[i].resolution, [&](int x, int y, int z) { return occupied(grids[i], x, y, z); });
        bits.grid = grids[i];
        OpacityPyramid pyramid = buildPyramid(std::move(bits), kind);
        if (i + 1 < grids.size()) linkCascade(pyramid, std::move(all));
        all = std::move(pyramid);
    }
    return all;
}

/// The voxels that hold the plane x = `plane`.
auto wallOfCascades(float plane)
{
    return [plane](const VoxelGrid& grid, int x, int, int) { return x == int(std::floor((plane - grid.origin.x) / grid.voxelSize)); };
}

bool equalBits(const Vec3& a, const Vec3& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

TEST_CASE("cascades: finer grids lie about the eye, in the coarsest, on every eighth of its voxels", "[voxel][cascades]")
{
    SearchRandom random(71);
    for (int trial = 0; trial < 200; ++trial) {
        const float size = random.uniform(0.01f, 2.0f);
        const VoxelGrid coarsest{Vec3(random.uniform(-50.0f, 50.0f), random.uniform(-50.0f, 50.0f), random.uniform(-50.0f, 50.0f)), size, 128};
        Vec3 eye;
        for (int axis = 0; axis < 3; ++axis) eye[axis] = coarsest.origin[axis] + random.uniform(-0.5f, 1.5f) * size * 128.0f;
        const std::vector<VoxelGrid> grids = cascadeGrids(coarsest, 4, eye);
        REQUIRE(grids.size() == 4);
        CHECK(grids.back() == coarsest);
        for (int i = 0; i < 3; ++i) {
            const VoxelGrid& grid = grids[std::size_t(i)];
            CHECK(grid.resolution == 128);
            CHECK(grid.voxelSize * float(8 >> i) == size);
            const double edge = 128.0 / double(8 >> i);
            for (int axis = 0; axis < 3; ++axis) {
                const double corner = (double(grid.origin[axis]) - double(coarsest.origin[axis])) / double(size), eighths = corner / 8.0;
                CHECK(std::abs(eighths - std::round(eighths)) < 1e-3);
                CHECK(corner > -1e-3);
                CHECK(corner + edge < 128.0 + 1e-3);
                const double off = (double(eye[axis]) - double(coarsest.origin[axis])) / double(size) - (corner + 0.5 * edge);
                const bool cut = corner < 1.0 || corner + edge > 127.0;
                CHECK((cut || std::abs(off) < 4.001));
            }
        }
    }
    CHECK(cascadeGrids(kCoarsestOfThree, 1, Vec3(100.0f)) == std::vector<VoxelGrid>{kCoarsestOfThree});
}

TEST_CASE("cascades: each holds the bits of one grid of its voxels over all", "[voxel][cascades]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    const VoxelGrid coarsest{Vec3(-0.5f), 0.03125f, 64};
    for (const Voxelization mode : {Voxelization::thin, Voxelization::conservative}) {
        const std::vector<VoxelGrid> grids = cascadeGrids(coarsest, 3, Vec3(0.3f, 0.2f, 0.4f));
        for (std::size_t i = 0; i < 2; ++i) {
            VoxelGrid fine{coarsest.origin, grids[i].voxelSize, 64 << (2 - int(i))};
            const BitGrid own = voxelize(*scene, grids[i], mode), whole = voxelize(*scene, fine, mode);
            const IVec3 corner((grids[i].origin - coarsest.origin) / grids[i].voxelSize + 0.5f);
            bool same = true;
            for (int z = 0; z < 64; ++z)
                for (int y = 0; y < 64; ++y)
                    for (int x = 0; x < 64; ++x) same = same && own.occupied(x, y, z) == whole.occupied(corner.x + x, corner.y + y, corner.z + z);
            CHECK(same);
            CHECK(own.countOccupied() > 1000);
        }
    }
}

TEST_CASE("cascades: well inside the finest a lookup is its own, far outside the coarser one's", "[voxel][cascades]")
{
    SearchRandom random(72);
    const std::vector<VoxelGrid> grids = cascadeGrids(kCoarsestOfThree, 2, Vec3(0.3f));
    const auto noise = [](const VoxelGrid& grid, int x, int y, int z) { return (x * 7 + y * 13 + z * 29 + int(64.0f * grid.voxelSize)) % 5 == 0; };
    for (const OpacityAxes axes : {OpacityAxes::directional, OpacityAxes::isotropic}) {
        const VoxelSettings kind{.resolution = 64, .axes = axes};
        const OpacityPyramid both = linkedGrids(grids, kind, noise), fine = linkedGrids({grids[0]}, kind, noise), coarse = linkedGrids({grids[1]}, kind, noise);
        for (int trial = 0; trial < 200; ++trial) {
            const float level = std::floor(random.uniform(0.0f, 3.0f));
            const Vec3 in(random.uniform(8.5f, 55.5f), random.uniform(8.5f, 55.5f), random.uniform(8.5f, 55.5f));
            CHECK(equalBits(sampleOpacity(both, in, level, FilterFraction::exact), sampleOpacity(fine, in, level, FilterFraction::exact)));
            Vec3 out = in;
            out[trial % 3] = trial & 1 ? -random.uniform(0.0f, 20.0f) : 64.0f + random.uniform(0.0f, 20.0f);
            const Vec3 world = grids[0].origin + out * grids[0].voxelSize;
            const Vec3 got = sampleOpacity(both, out, level, FilterFraction::exact);
            const Vec3 wanted = 0.5f * sampleOpacity(coarse, grids[1].voxelsFromWorld(world), std::max(level - 1.0f, 0.0f), FilterFraction::exact);
            CHECK(glm::length(got - wanted) < 1e-5f);
        }
    }
}

TEST_CASE("cascades: no lookup jumps anywhere", "[voxel][cascades]")
{
    const std::vector<VoxelGrid> grids = cascadeGrids(kCoarsestOfThree, 3, Vec3(-0.2f, 0.4f, 0.1f));
    const OpacityPyramid all = linkedGrids(grids, {.resolution = 64}, [](const VoxelGrid&, int x, int y, int z) { return (x * 5 + y * 3 + z * 11) % 7 < 3; });
    // A trilinear lookup changes by no more than 1 a texel along each axis, the share by 1 / kCascadeBlendVoxels a voxel.
    const Vec3 step(0.01f, 0.007f, -0.004f);
    const float bound = 1.5f * (step.x + step.y - step.z);
    for (const float level : {0.0f, 1.0f, 2.5f}) {
        Vec3 last = sampleOpacity(all, Vec3(-100.0f, -60.0f, 70.0f), level, FilterFraction::exact);
        float most = 0.0f, held = 0.0f;
        for (int i = 1; i < 25000; ++i) {
            const Vec3 next = sampleOpacity(all, Vec3(-100.0f, -60.0f, 70.0f) + float(i) * step, level, FilterFraction::exact);
            most = std::max({most, std::abs(next.x - last.x), std::abs(next.y - last.y), std::abs(next.z - last.z)});
            held = std::max(held, next.x);
            last = next;
        }
        CHECK(most < bound);
        CHECK(held > 0.1f);
    }
}

TEST_CASE("cascades: a wall covers a ray once, whichever grids answer", "[voxel][cascades]")
{
    const std::vector<VoxelGrid> grids = cascadeGrids(kCoarsestOfThree, 3, Vec3(0.1f));
    const float plane = 0.3f;
    const OpacityPyramid all = linkedGrids(grids, {.resolution = 64}, wallOfCascades(plane));
    const float at = (plane - grids[0].origin.x) / grids[0].voxelSize;
    for (const float level : {0.0f, 1.0f, 2.0f})
        for (float y = -30.0f; y < 90.0f; y += 0.37f) {  // along the wall: through the finest grid, its borders, and the coarser ones
            const float width = std::exp2(level);
            double covered = 0.0;
            for (float x = at - 40.0f; x < at + 40.0f; x += width)
                covered += double(width * sampleOpacity(all, Vec3(x, y, 30.0f), level, FilterFraction::exact).x);
            CAPTURE(level, y);
            REQUIRE(std::abs(covered - 1.0) < 1e-4);
        }
}

TEST_CASE("cascades: receivers near a border divide by their threshold, and lie in the finest grid that holds them", "[voxel][cascades]")
{
    const std::vector<VoxelGrid> grids = cascadeGrids(kCoarsestOfThree, 3, Vec3(0.1f));
    const OpacityPyramid all = linkedGrids(grids, {.resolution = 64}, wallOfCascades(0.0f));
    const auto at = [&](float x, float threshold) { return cascadeOfReceiver(all, grids[0].origin + Vec3(x, 32.0f, 32.0f) * grids[0].voxelSize, threshold); };
    CHECK(at(32.0f, 0.97f) == 0);
    CHECK(at(7.9f, 0.0f) == 1);
    CHECK(at(10.5f, 0.47f) == 0);  // half way over the four voxels
    CHECK(at(10.5f, 0.53f) == 1);
    CHECK(at(12.6f, 0.97f) == 0);
    CHECK(at(-100.0f, 0.0f) == 2);
    const OpacityPyramid lone = linkedGrids({grids[2]}, {.resolution = 64}, wallOfCascades(0.0f));
    CHECK(cascadeOfReceiver(lone, Vec3(1e6f), 0.5f) == 0);
}
