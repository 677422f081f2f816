#pragma once

#include "apps/validate/equations/synthetic_maps.h"
#include "conetrace/frame/cone.h"
#include "conetrace/frame/cone_batch.h"
#include "conetrace/frame/lane_widths.h"
#include "voxel/bit_grid.h"

#include "catch.h"

#include <cstring>
#include <memory>
#include <vector>

/// Batches of cones held to a scalar march.
namespace lrsm::test {

struct Cones {
    ConeBatch batch;
    std::vector<ConeRay> rays;
};

/// From anywhere in and around the grid; axes exactly along x, y or z among them.
inline std::unique_ptr<Cones> randomCones(const VoxelGrid& grid, int count, SearchRandom& random)
{
    auto cones = std::make_unique<Cones>();
    cones->batch.count = count;
    for (int k = 0; k < count; ++k) {
        const float n = float(grid.resolution);
        const Vec3 voxels(random.uniform(-0.1f * n, 1.1f * n), random.uniform(0.0f, n), random.uniform(0.0f, n));
        Vec3 direction = randomUnit(random);
        if (k % 11 == 3) direction = Vec3(k % 2 ? 1.0f : 0.0f, k % 2 ? 0.0f : -1.0f, 0.0f);
        const Vec3 world = grid.origin + voxels * grid.voxelSize, normal = randomUnit(random);
        cones->rays.push_back({.originWorld = world, .originVoxels = voxels, .direction = direction, .receiverNormal = normal});
        cones->batch.setOrigin(k, voxels, world, normal);
        cones->batch.setDirection(k, direction);
    }
    return cones;
}

/// scalar(ray, counts) is a ConeResult; batch(lanes, cones, result, counts) must have its bits and counts at every width of this machine. Returns how many
/// cones bring light.
template <class Scalar, class Batch>
int holdBatch(const Cones& cones, const Scalar& scalar, const Batch& batch)
{
    std::vector<ConeResult> expected;
    ConeCounts expectedCounts;
    int lit = 0;
    for (const ConeRay& ray : cones.rays) expected.push_back(scalar(ray, expectedCounts));
    for (const ConeResult& cone : expected) lit += cone.radiance != Vec3(0.0f);
    for (const int lanes : laneWidths()) {
        CAPTURE(cones.batch.count, lanes);
        const auto result = std::make_unique<ConeBatchResult>();
        std::memset(result.get(), 0x7f, sizeof *result);
        ConeCounts counts;
        batch(lanes, cones.batch, *result, counts);
        for (std::size_t k = 0; k < expected.size(); ++k) {
            CAPTURE(k);
            REQUIRE(std::memcmp(&expected[k].radiance, result->radiance[k], sizeof expected[k].radiance) == 0);
            REQUIRE(std::memcmp(&expected[k].opacity, &result->opacity[k], sizeof expected[k].opacity) == 0);
        }
        REQUIRE(counts == expectedCounts);
    }
    return lit;
}

}  // namespace lrsm::test
