#include "validation/voxel_ray.h"

#include "core/base/rng.h"

#include "catch.h"

using namespace lrsm;

namespace {

BitGrid emptyGrid(int resolution)
{
    BitGrid grid;
    grid.frame.resolution = resolution;
    const auto bricks = std::size_t(BitGrid::bricksPerEdge(resolution));
    grid.bricks.assign(bricks * bricks * bricks, 0);
    return grid;
}

void set(BitGrid& grid, int x, int y, int z)
{
    grid.bricks[grid.brickIndex(x, y, z)] |= std::uint64_t(1) << BitGrid::bitIndex(x, y, z);
}

struct Random {
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
    const int resolution = GENERATE(2, 8, 32);
    Random random;
    int hits = 0, misses = 0;
    for (int round = 0; round < 4; ++round) {
        BitGrid grid = emptyGrid(resolution);
        std::vector<glm::ivec3> occupied;
        const int count = std::max(1, resolution * resolution / 16);
        for (int i = 0; i < count; ++i) {
            glm::ivec3 cell;
            for (int a = 0; a < 3; ++a) cell[a] = int(random() * float(resolution));
            set(grid, cell.x, cell.y, cell.z);
            occupied.push_back(cell);
        }
        for (int i = 0; i < 500; ++i) {
            Vec3 origin, direction;
            for (int a = 0; a < 3; ++a) origin[a] = (random() * 1.5f - 0.25f) * float(resolution);
            for (int a = 0; a < 3; ++a) direction[a] = random() - 0.5f;
            direction = glm::normalize(direction);
            const float start = i % 3 == 0 ? 0.0f : random() * 4.0f;

            double certain = 1e300, possible = 1e300;  // first hit, without and with grazed voxels
            for (const glm::ivec3& cell : occupied) {
                const Interval span = throughVoxel(cell, glm::dvec3(origin), glm::dvec3(direction));
                const double begin = std::max(span.begin, double(start));
                if (span.end - begin > kGraze) certain = std::min(certain, begin);
                if (span.end - begin > -kGraze) possible = std::min(possible, begin);
            }
            const std::optional<float> hit = firstOccupied(grid, origin, direction, start);
            CAPTURE(resolution, i, certain, possible, hit.value_or(-1.0f));
            if (hit) {
                REQUIRE(double(*hit) >= possible - 1e-3);
                REQUIRE(double(*hit) <= certain + 1e-3);
                ++hits;
            } else {
                REQUIRE(certain == 1e300);
                ++misses;
            }
        }
    }
    CHECK(hits > 100);
    CHECK(misses > 100);
}

TEST_CASE("voxel rays along an axis: distances are exact, a start inside a voxel counts, a ray beside the grid meets nothing", "[validation][voxel-ray]")
{
    BitGrid grid = emptyGrid(16);
    set(grid, 9, 5, 5);
    const Vec3 plusX(1, 0, 0);
    CHECK(firstOccupied(grid, Vec3(0.5f, 5.5f, 5.5f), plusX, 0.0f) == 8.5f);
    CHECK(firstOccupied(grid, Vec3(15.5f, 5.5f, 5.5f), -plusX, 0.0f) == 5.5f);
    CHECK(firstOccupied(grid, Vec3(-4.0f, 5.5f, 5.5f), plusX, 0.0f) == 13.0f);
    CHECK(firstOccupied(grid, Vec3(0.5f, 5.5f, 5.5f), plusX, 9.0f) == 9.0f);
    CHECK(!firstOccupied(grid, Vec3(0.5f, 5.5f, 5.5f), plusX, 9.5f));
    CHECK(!firstOccupied(grid, Vec3(0.5f, 6.5f, 5.5f), plusX, 0.0f));
    CHECK(!firstOccupied(grid, Vec3(0.5f, -0.5f, 5.5f), plusX, 0.0f));
    CHECK(!firstOccupied(grid, Vec3(17.0f, 5.5f, 5.5f), plusX, 0.0f));
}
