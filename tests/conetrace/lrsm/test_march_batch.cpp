// The batch kernel against the scalar march, bit for bit, at every width of this machine: random voxels, random maps, every kind of pyramid and setting, and
// batches that fill no vector.
#include "conetrace/lrsm/gather_pixel.h"
#include "conetrace/lrsm/march_slab_batch.h"

#include "apps/validate/equations/synthetic_maps.h"

#include "catch.h"
#include "tests/conetrace/cone_batches.h"

#include <memory>

using namespace lrsm;

namespace {

constexpr float kEdge = 0.25f;

OpacityPyramid randomVoxels(int resolution, const VoxelSettings& kind, SearchRandom& random)
{
    BitGrid bits;
    bits.grid = {Vec3(-0.5f * kEdge * float(resolution)), kEdge, resolution};
    const auto edge = std::size_t(BitGrid::bricksPerEdge(resolution));
    bits.bricks.assign(edge * edge * edge, 0);
    // Walls: whole rows of every third brick, so that cones are stopped at different places and much is empty.
    for (int z = 0; z < resolution; ++z)
        for (int y = 0; y < resolution; ++y)
            for (int x = 0; x < resolution; ++x)
                if ((x * 7 + y * 3 + z * 5) % 23 == 0 && random.uniform(0.0f, 1.0f) < 0.4f)
                    bits.bricks[bits.brickIndex(x, y, z)] |= std::uint64_t(1) << BitGrid::bitIndex(x, y, z);
    VoxelSettings settings = kind;
    settings.resolution = resolution;
    return buildPyramid(std::move(bits), settings);
}

LightProjection lightOver(const VoxelGrid& grid, LightType type, SearchRandom& random)
{
    LightProjection q;
    const Mat3 axes = basisFromNormal(randomUnit(random));
    const float extent = grid.voxelSize * float(grid.resolution);
    q.type = type;
    q.right = axes[0], q.up = axes[1], q.forward = -axes[2];
    // A spot's cone and a face's quarter leave some of the grid outside the map; the face's light stands in the grid.
    q.position = axes[2] * (type == LightType::cubeFace ? 0.1f * extent : 1.2f * extent);
    q.halfWidth = type == LightType::directional ? 0.7f * extent : type == LightType::spot ? 0.4f : 1.0f;
    q.depthFar = 2.5f * extent;
    q.resolution = 32;
    return q;
}

Rsm randomMap(const LightProjection& q, SearchRandom& random)
{
    return syntheticMap(q, [&](int, int) {
        return MapTexel{.depth = random.uniform(0.2f, 0.8f),
                        .radiance = Vec3(random.uniform(0.0f, 4.0f), random.uniform(0.0f, 1.0f), random.uniform(0.0f, 2.0f)),
                        .normal = glm::normalize(randomUnit(random) - q.forward),
                        .nDotL = random.uniform(0.1f, 1.0f),
                        .coverage = random.uniform(0.0f, 1.0f) < 0.8f ? 1.0f : 0.0f};
    });
}

struct BatchCase {
    const char* name;
    int resolution = 64;
    VoxelSettings voxels = {};
    ConeSettings cones = {};
    LayerSettings layers = {};
    int lights = 3;
    int cascades = 1;
};

/// Random voxels in each of several grids, nowhere in each other's middle.
OpacityPyramid randomCascades(const BatchCase& c, SearchRandom& random)
{
    OpacityPyramid finer = randomVoxels(c.resolution, c.voxels, random);
    std::vector<OpacityPyramid> all = {finer};
    for (int i = 1; i < c.cascades; ++i) {
        OpacityPyramid next = randomVoxels(c.resolution, c.voxels, random);
        const VoxelGrid& grid = all.back().base.grid;
        next.base.grid = {grid.origin - Vec3(8.0f, 24.0f, 16.0f) * grid.voxelSize, 2.0f * grid.voxelSize, grid.resolution};
        all.push_back(std::move(next));
    }
    while (all.size() > 1) {
        OpacityPyramid coarser = std::move(all.back());
        all.pop_back();
        linkCascade(all.back(), std::move(coarser));
    }
    return all.front();
}

/// Of the scalar march, cone by cone.
ConeResult scalar(const ConeWorld& world, const ConeRay& ray, const MarchSchedule& schedule, ConeCounts& counts)
{
    MarchScratch scratch;
    NoRecorder recorder;
    return marchSlab(world, GenericSampler{world.opacity, world.settings.march.filterFraction}, ray, schedule, scratch, counts, recorder);
}

void holdBatch(const BatchCase& c, std::uint32_t seed)
{
    CAPTURE(c.name, c.resolution);
    SearchRandom random(seed);
    const OpacityPyramid opacity = randomCascades(c, random);
    const VoxelGrid& grid = opacity.base.grid;
    std::vector<Lrsm> lrsms;
    for (int l = 0; l < c.lights; ++l) {
        const LightType type = l % 3 == 0 ? LightType::directional : l % 3 == 1 ? LightType::spot : LightType::cubeFace;
        lrsms.push_back(buildLrsm(randomMap(lightOver(grid, type, random), random), c.layers));
    }
    const NormalCdf phi(c.cones.gather.gaussian, c.cones.gather.gaussianTableSize);
    const ConeWorld world{.opacity = opacity, .lrsms = lrsms, .settings = c.cones, .phi = phi};
    const BatchWorld batchWorld(world);
    const MarchSchedule schedule = makeSchedule(c.cones, 0.4f, 1.74f * float(outermostEdge(opacity)));

    const auto scratch = std::make_unique<MarchBatchScratch>();
    for (const int count : {1, 5, 17, 100}) {
        const int lit = test::holdBatch(
            *test::randomCones(grid, count, random), [&](const ConeRay& ray, ConeCounts& counts) { return scalar(world, ray, schedule, counts); },
            [&](int lanes, const ConeBatch& cones, ConeBatchResult& result, ConeCounts& counts) {
                marchSlabBatch(lanes)(batchWorld, schedule, cones, *scratch, result, counts);
            });
        if (count == 100 && c.resolution >= 16 && c.lights > 0) CHECK(lit > 20);
    }
}

std::vector<BatchCase> allCases()
{
    std::vector<BatchCase> cases;
    for (const OpacityAxes axes : {OpacityAxes::directional, OpacityAxes::isotropic})
        for (const Storage storage : {Storage::gpu, Storage::float32})
            for (const FilterFraction fraction : {FilterFraction::exact, FilterFraction::fixed8}) {
                BatchCase c{.name = "kinds of pyramid"};
                c.voxels.axes = axes;
                c.voxels.storage = storage;
                c.cones.march.filterFraction = fraction;
                cases.push_back(c);
            }
    for (const int resolution : {1, 2, 4, 8, 32}) {
        BatchCase c{.name = "small grids", .resolution = resolution};
        cases.push_back(c);
        c.voxels.axes = OpacityAxes::isotropic;
        cases.push_back(c);
    }
    BatchCase choices{.name = "exponential, table, no cutoff"};
    choices.cones.march.transmittance = TransmittanceModel::exponential;
    choices.cones.march.transmittanceCutoff = 0.0f;
    choices.cones.gather.gaussian = GaussianMethod::table;
    cases.push_back(choices);
    choices.name = "exact Phi, slanted emitters, sharp maps";
    choices.cones.gather.gaussian = GaussianMethod::exact;
    choices.cones.gather.emitterSlantCap = 0.25f;
    choices.cones.gather.rsmLevelBias = -1.5f;
    choices.cones.gather.rsmMinLevel = 1.0f;
    cases.push_back(choices);
    BatchCase layered{.name = "more layers than a lane has bits", .resolution = 32, .lights = 2};
    layered.layers.depthLayers = 16;
    layered.layers.normalLayers = 4;
    layered.layers.dropEmpty = false;
    cases.push_back(layered);
    cases.push_back({.name = "64 lights", .resolution = 16, .lights = 64});
    cases.push_back({.name = "no light", .resolution = 16, .lights = 0});
    for (int cascades = 2; cascades <= 4; ++cascades) cases.push_back({.name = "cascades", .resolution = 32, .cascades = cascades});
    BatchCase opacities{.name = "cascades, one opacity a voxel", .resolution = 32, .cascades = 2};
    opacities.voxels.axes = OpacityAxes::isotropic;
    cases.push_back(opacities);
    return cases;
}

}  // namespace

TEST_CASE("a batch of cones has the scalar march's bits at every width", "[conetrace][march][slab]")
{
    std::uint32_t seed = 4100;
    for (const BatchCase& c : allCases()) holdBatch(c, seed++);
}

TEST_CASE("a width that the machine lacks is answered by the next narrower", "[conetrace][march]")
{
    const std::vector<int> widths = laneWidths();
    CHECK(widths.front() == 4);
    CHECK(marchSlabBatch(0) == marchSlabBatch(widths.back()));
    CHECK(marchSlabBatch(5) == marchSlabBatch(4));
    CHECK(marchSlabBatch(1000) == marchSlabBatch(widths.back()));
    for (std::size_t i = 1; i < widths.size(); ++i) CHECK(marchSlabBatch(widths[i]) != marchSlabBatch(widths[i - 1]));
}
