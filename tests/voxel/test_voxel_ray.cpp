#include "voxel/voxel_ray.h"

#include "apps/validate/equations/synthetic_grids.h"

#include "catch.h"

using namespace lrsm;

namespace {

struct RayRandom {
    std::uint32_t counter = 0;
    float operator()() { return unitFloat(philox({counter++, 0, 0, 0}, {7, 11})[0]); }
};

/// Where the line passes through one voxel, in double: the slab method on that voxel alone.
struct Interval {
    double begin, end;
};
Interval throughVoxel(const glm::ivec3& cell, const glm::dvec3& origin, const glm::dvec3& direction)
{
    Interval span{-1e300, 1e300};
    for (int a = 0; a < 3; ++a) {
        const double s = (cell[a] - origin[a]) / direction[a], t = (cell[a] + 1 - origin[a]) / direction[a];
        span = {std::max(span.begin, std::min(s, t)), std::min(span.end, std::max(s, t))};
    }
    return span;
}

}  // namespace

TEST_CASE("voxel rays stop where brute force over all occupied voxels says", "[validation][voxel-ray]")
{
    constexpr double kGraze = 1e-4;  // shorter ways through a voxel may be missed, or found, by rounding
    const int resolution = GENERATE(2, 16, 64);
    RayRandom random;
    int hits = 0, misses = 0;
    for (int round = 0; round < 4; ++round) {
        std::vector<glm::ivec3> occupied;
        const OpacityPyramid pyramid = pyramidOf(gridOf(resolution, [&](int x, int y, int z) {
            if (random() * float(4 * resolution) >= 1.0f) return false;
            occupied.push_back({x, y, z});
            return true;
        }));
        for (int i = 0; i < 1500; ++i) {
            Vec3 origin, direction;
            Vec3 target;
            for (int a = 0; a < 3; ++a) origin[a] = (random() * 1.5f - 0.25f) * float(resolution);
            for (int a = 0; a < 3; ++a) target[a] = random() * float(resolution);
            direction = glm::normalize(target - origin);
            const float start = i % 3 == 0 ? 0.0f : random() * 4.0f;

            double certain = 1e300, possible = 1e300;  // first hit, without and with grazed voxels
            for (const glm::ivec3& cell : occupied) {
                const Interval span = throughVoxel(cell, glm::dvec3(origin), glm::dvec3(direction));
                const double begin = std::max(span.begin, double(start));
                if (span.end - begin > kGraze) certain = std::min(certain, begin);
                if (span.end - begin > -kGraze) possible = std::min(possible, begin);
            }
            const std::optional<VoxelRun> hit = firstOccupied(pyramid, origin, direction, start);
            CAPTURE(resolution, i, certain, possible);
            if (hit) {
                REQUIRE(double(hit->enter) >= possible - 1e-3);
                REQUIRE(double(hit->enter) <= certain + 1e-3);
                REQUIRE(hit->leave >= hit->enter);
                ++hits;
            } else {
                REQUIRE(certain == 1e300);
                ++misses;
            }
        }
    }
    CHECK(hits > 900);
    CHECK(misses > 500);
}

TEST_CASE("voxel rays along an axis: distances are exact, a start inside a voxel counts, a ray beside the grid meets nothing", "[validation][voxel-ray]")
{
    const OpacityPyramid pyramid = pyramidOf(gridOf(16, [](int x, int y, int z) { return (x == 9 || x == 10) && y == 5 && z == 5; }));
    const Vec3 plusX(1, 0, 0);
    const auto enters = [&](const Vec3& origin, const Vec3& direction, float start) {
        const auto run = firstOccupied(pyramid, origin, direction, start);
        return run ? run->enter : -1.0f;
    };
    CHECK(enters(Vec3(0.5f, 5.5f, 5.5f), plusX, 0.0f) == 8.5f);
    CHECK(firstOccupied(pyramid, Vec3(0.5f, 5.5f, 5.5f), plusX, 0.0f)->leave == 10.5f);
    CHECK(firstOccupied(pyramid, Vec3(9.5f, -1.0f, 5.5f), Vec3(0, 1, 0), 0.0f)->leave == 7.0f);
    CHECK(enters(Vec3(15.5f, 5.5f, 5.5f), -plusX, 0.0f) == 4.5f);
    CHECK(enters(Vec3(-4.0f, 5.5f, 5.5f), plusX, 0.0f) == 13.0f);
    CHECK(enters(Vec3(0.5f, 5.5f, 5.5f), plusX, 10.0f) == 10.0f);
    CHECK(enters(Vec3(0.5f, 5.5f, 5.5f), plusX, 10.5f) == -1.0f);
    CHECK(enters(Vec3(0.5f, 6.5f, 5.5f), plusX, 0.0f) == -1.0f);
    CHECK(enters(Vec3(0.5f, -0.5f, 5.5f), plusX, 0.0f) == -1.0f);
    CHECK(enters(Vec3(17.0f, 5.5f, 5.5f), plusX, 0.0f) == -1.0f);
}
