#include "catch.h"
#include "tests/conetrace/explanation.h"

#include "conetrace/render.h"
#include "conetrace/vct/gather.h"
#include "conetrace/vct/inject.h"
#include "conetrace/vct/march.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/shapes.h"
#include "core/settings/settings_table.h"
#include "voxel/voxelize.h"

#include <cmath>
#include <numbers>

using namespace lrsm;

namespace {

struct Silent {};

/// A lit plane of one voxel, normal -x, across a grid of n^3; radiance 1 where it emits, on both sides if `bothSides`.
RadianceVolume plane(int n, int x, const VctSettings& settings)
{
    BitGrid bits;
    bits.grid.resolution = n;
    bits.bricks.assign(predictBitGridBytes(n) / sizeof(std::uint64_t), 0);
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y) bits.bricks[bits.brickIndex(x, y, z)] |= std::uint64_t(1) << BitGrid::bitIndex(x, y, z);
    RadianceVolume volume = darkVolume(bits);
    for (std::size_t i = 0; i < volume.base.size(); ++i) {
        if (volume.base[i].w == 0.0f) continue;
        volume.base[i] = Vec4(1.0f);
        volume.normals[i] = Vec4(-1.0f, 0.0f, 0.0f, 0.0f);
    }
    buildRadianceMips(volume, settings);
    return volume;
}

struct Seen {
    double mean = 0.0, least = 2.0, radianceOverOpacity = 0.0;
};

/// Opacity of the plane at `level` seen at an angle, over all phases of place and step: steps of half a texel.
Seen lookAtPlane(int level, double angleDegrees, const VctSettings& vct, TransmittanceModel transmittance)
{
    constexpr int kResolution = 512, kPhases = 24;
    static const RadianceVolume volume = plane(kResolution, 256, VctSettings{.storage = Storage::float32});
    const VoxelGrid grid{.origin = Vec3(0.0f), .voxelSize = 1.0f, .resolution = kResolution};
    ConeSettings cones;
    cones.march.transmittance = transmittance;
    cones.march.transmittanceCutoff = 0.0f;
    const VctWorld world{.volume = volume, .grid = grid, .cones = cones, .vct = vct};
    const float width = float(1 << level), cosine = float(std::cos(angleDegrees * std::numbers::pi / 180.0));
    const Vec3 direction(cosine, std::sqrt(1.0f - cosine * cosine), 0.0f);
    Seen seen;
    for (int phase = 0; phase < kPhases; ++phase) {
        MarchSchedule schedule;
        const float start = 0.5f * width * float(phase) / kPhases;
        for (int k = 0; k < 64; ++k) {
            const float t = start + 0.5f * width * float(k);
            schedule.steps.push_back({.middle = t, .begin = t, .end = t + 0.5f * width, .diameter = width, .level = float(level), .tapWidth = width});
        }
        const Vec3 origin = Vec3(256.5f, 256.0f, 256.0f) - 16.0f * width * direction;
        ConeCounts counts;
        Silent silent;
        const ConeResult cone = marchRadiance(world, {.originVoxels = origin, .direction = direction}, schedule, counts, silent);
        seen.mean += double(cone.opacity) / kPhases;
        seen.least = std::min(seen.least, double(cone.opacity));
        seen.radianceOverOpacity += double(cone.radiance.y / cone.opacity) / kPhases;
    }
    return seen;
}

Settings smallVct(const std::string& name)
{
    Settings settings = preset(name);
    settings.voxel.resolution = 64;
    settings.rsm.resolution = 128;
    return settings;
}

Frame renderVct(const Scene& scene, const Settings& settings)
{
    RenderOptions options;
    options.width = 48;
    options.height = 36;
    return renderFrame(scene, scene.cameras.at(0), settings, options);
}

std::vector<std::string> hashesOf(const Frame& frame)
{
    std::vector<std::string> all;
    for (const PassReport& pass : frame.passes) all.push_back(pass.name + " " + pass.sha256);
    return all;
}

/// A floor of 2 m in a plane of voxel centres, under a sun at an angle; `shade`: a blocker high above that keeps it from x < 0.
struct FloorWorld {
    Scene scene;
    Settings settings;
    Requirements needs;
    OpacityPyramid opacity;
    std::vector<Rsm> rsms;
    GBuffer nothing;
    GatherInput input() const
    {
        return {.scene = scene, .camera = scene.cameras[0], .needs = needs, .settings = settings, .gbuffer = nothing, .rsms = rsms, .opacity = opacity};
    }
};
constexpr float kAlbedo = 0.5f, kSun = 8.0f, kSunCosine = 0.8f;

FloorWorld floorWorld(bool shade, const VctSettings& vct, float rsmTexelsAVoxel = 4.0f)
{
    FloorWorld world;
    Scene& scene = world.scene;
    scene.materials = {diffuseMaterial("grey", Vec3(kAlbedo), true)};
    scene.meshes.resize(2);
    addQuad(scene.meshes[0], {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
    if (shade)
        addQuad(scene.meshes[1], {-1, 0.8f, 1}, {-0.013f, 0.8f, 1}, {-0.013f, 0.8f, -1}, {-1, 0.8f, -1});
    else
        addQuad(scene.meshes[1], {0, -0.8f, 0.1f}, {0.1f, -0.8f, 0.1f}, {0.1f, -0.8f, 0}, {0, -0.8f, 0});  // so that the floor lies within a layer of voxels
    scene.lights = {directionalLight(shade ? Vec3(0, -1, 0) : Vec3(0.6f, -kSunCosine, 0.0f), Vec3(kSun))};
    scene.cameras = {lookAt({0, 3, 3}, {0, 0, 0}, {0, 1, 0}, 0.8f)};
    updateBounds(scene);
    world.settings.vct = vct;
    world.settings.voxel.resolution = 32;
    world.settings.rsm.resolution = int(32 * rsmTexelsAVoxel);
    world.needs = analyseRequirements(scene, {});
    world.opacity.base = voxelize(scene, world.settings.voxel);
    world.rsms = {renderRsm(scene, scene.lights[0], world.needs, world.settings.rsm)};
    return world;
}

RadianceVolume injected(const FloorWorld& world)
{
    const GatherInput input = world.input();
    const VoxelSurface surface = voxelSurface(world.scene, world.opacity.base, world.settings.voxel, TextureFilter::trilinear);
    return injectRadiance(input, &surface);
}

/// visit(x, texel) for the base texels of the floor's own voxels.
template <class Visit>
void forFloor(const FloorWorld& world, const RadianceVolume& volume, const Visit& visit)
{
    const BitGrid& bits = world.opacity.base;
    const int y = int(std::floor(bits.grid.voxelsFromWorld(Vec3(0.0f)).y));
    for (int z = 4; z < 28; ++z)
        for (int x = 4; x < 28; ++x)
            if (bits.occupied(x, y, z)) visit(x, volume.base[volume.maps[0].texel(x, y, z)], volume.normals[volume.maps[0].texel(x, y, z)]);
}

}  // namespace

TEST_CASE("vct: a one-voxel plane's opacity over phases and angles, and I = L times it", "[conetrace][vct]")
{
    struct Row {
        DirectionWeights weights;
        StepOpacity opacity;
        double mean[3], least[3];
    };
    const Row rows[] = {{DirectionWeights::squared, StepOpacity::step, {0.855, 0.709, 0.687}, {0.812, 0.703, 0.686}},
                        {DirectionWeights::absolute, StepOpacity::step, {0.855, 0.891, 0.891}, {0.812, 0.878, 0.888}},
                        {DirectionWeights::absolute, StepOpacity::none, {0.977, 0.988, 0.988}, {0.965, 0.985, 0.987}}};
    const double angles[] = {0.0, 45.0, 60.0};
    VctSettings vct;
    vct.storage = Storage::float32;
    for (const Row& row : rows)
        for (int k = 0; k < 3; ++k) {
            vct.weights = row.weights;
            vct.opacity = row.opacity;
            const Seen seen = lookAtPlane(3, angles[k], vct, TransmittanceModel::exponential);
            CAPTURE(int(row.weights), int(row.opacity), angles[k]);
            CHECK(seen.mean == Approx(row.mean[k]).margin(2e-3));
            CHECK(seen.least == Approx(row.least[k]).margin(2e-3));
            CHECK(seen.radianceOverOpacity == Approx(1.0).epsilon(double(kVctMarchMaxError)));
        }
    vct.weights = DirectionWeights::absolute;
    vct.opacity = StepOpacity::step;
    for (const double angle : angles) {
        const Seen seen = lookAtPlane(3, angle, vct, TransmittanceModel::linear);
        CHECK(seen.mean == Approx(1.0).margin(0.02));
        CHECK(seen.radianceOverOpacity == Approx(1.0).epsilon(double(kVctMarchMaxError)));
    }
}

TEST_CASE("vct: a wall sends nothing to who comes from behind it", "[conetrace][vct]")
{
    VctSettings vct;
    const RadianceVolume volume = plane(64, 32, vct);
    const VoxelGrid grid{.origin = Vec3(0.0f), .voxelSize = 1.0f, .resolution = 64};
    const ConeSettings cones;
    const VctWorld world{.volume = volume, .grid = grid, .cones = cones, .vct = vct};
    const MarchSchedule schedule = planVct(cones, Requirements{}, 64).ringSchedules.front();
    ConeCounts counts;
    Silent silent;
    const auto seenFrom = [&](float x, float towards) {
        return marchRadiance(world, {.originVoxels = {x, 32, 32}, .direction = {towards, 0, 0}}, schedule, counts, silent);
    };
    CHECK(seenFrom(20, 1).radiance.x > 0.7f);
    CHECK(seenFrom(44, -1).radiance.x < 1e-3f);
    CHECK(seenFrom(44, -1).opacity > 0.7f);
}

TEST_CASE("vct: injected radiance is rho L cos / pi, by either way, whatever the map's resolution", "[conetrace][vct][inject]")
{
    for (const Injection injection : {Injection::rsm, Injection::voxel})
        for (const float texels : {2.0f, 8.0f}) {
            const FloorWorld world = floorWorld(false, {.injection = injection}, texels);
            const RadianceVolume volume = injected(world);
            const double expected = double(kAlbedo * kSun * kSunCosine) / std::numbers::pi;
            int count = 0;
            forFloor(world, volume, [&](int, const Vec4& texel, const Vec4& normal) {
                ++count;
                CHECK(double(texel.x) == Approx(expected).epsilon(2e-3));
                CHECK(texel.w == 1.0f);
                CHECK(normal.y == Approx(1.0f).margin(2e-3));
            });
            CHECK(count > 500);
            if (injection == Injection::rsm) CHECK(counterSum(volume.counters, "texels_lost") == 0.0);
        }
}

TEST_CASE("vct: at a shadow's edge the mean fills its voxel, by area it is lit in part", "[conetrace][vct][inject]")
{
    const double full = double(kAlbedo * kSun) / std::numbers::pi;
    for (const InjectionWeight weight : {InjectionWeight::mean, InjectionWeight::area}) {
        const FloorWorld world = floorWorld(true, {.injectionWeight = weight}, 16.0f);
        const RadianceVolume volume = injected(world);
        const VoxelGrid& grid = world.opacity.base.grid;
        const float edge = grid.voxelsFromWorld(Vec3(-0.013f, 0, 0)).x;
        const int own = int(edge);
        const double lit = double(float(own + 1) - edge);
        REQUIRE(lit > 0.1);
        REQUIRE(lit < 0.9);
        forFloor(world, volume, [&](int x, const Vec4& texel, const Vec4&) {
            const double expected = x < own ? 0.0 : x > own || weight == InjectionWeight::mean ? full : full * lit;
            CHECK(double(texel.x) == Approx(expected).margin(0.1 * full));
        });
    }
}

TEST_CASE("vct: two lights are the sum of each", "[conetrace][vct][inject]")
{
    FloorWorld world = floorWorld(false, {.storage = Storage::float32});
    const RadianceVolume one = injected(world);
    world.scene.lights.push_back(world.scene.lights[0]);
    world.rsms.push_back(world.rsms[0]);
    const RadianceVolume two = injected(world);
    for (std::size_t i = 0; i < one.base.size(); ++i) REQUIRE(Vec3(two.base[i]) * one.preExposure == 2.0f * Vec3(one.base[i]) * two.preExposure);
    CHECK(one.normals == two.normals);
}

TEST_CASE("vct: the same bits with 1, 2 and 8 threads, pass by pass", "[conetrace][vct][invariance]")
{
    const auto scene = makeBuiltinScene("atrium");
    const Settings settings = smallVct(GENERATE("vct", "vct-paper"));
    std::vector<std::string> first;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        const std::vector<std::string> now = hashesOf(renderVct(*scene, settings));
        if (first.empty()) first = now;
        CHECK(now == first);
    }
}

TEST_CASE("vct: it builds what it reads, and holds what it said it would", "[conetrace][vct]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    const Settings settings = smallVct("vct");
    const Frame frame = renderVct(*scene, settings);
    std::vector<std::string> names;
    for (const PassReport& pass : frame.passes) names.push_back(pass.name);
    CHECK(names == std::vector<std::string>{"voxelize", "rsm 0", "gbuffer", "direct", "vct surface", "vct inject", "vct mips", "vct cones", "filter",
                                            "specular filter", "smooth", "composite"});
    for (const PassReport& pass : frame.passes) CHECK(pass.nonFinite == 0);
    std::vector<MemoryRow> rows = predictMemory({.scene = *scene, .needs = frame.needs, .settings = settings, .width = 48, .height = 36});
    addMeasured(rows, frame.passes);
    for (const MemoryRow& row : rows) {
        CAPTURE(row.structure);
        REQUIRE(row.measured.has_value());
        CHECK(*row.measured == row.predicted);
    }
}

TEST_CASE("vct: the explanation names every cone and ends with the pixel's own irradiance", "[conetrace][vct][pixel]")
{
    checkExplanation(smallVct("vct"));
}
