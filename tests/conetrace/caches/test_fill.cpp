#include "conetrace/caches/gather.h"
#include "conetrace/caches/light_voxels.h"

#include "conetrace/render.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/shapes.h"
#include "core/settings/settings_table.h"
#include "tests/conetrace/caches/surfaces.h"
#include "voxel/voxelize.h"

#include "catch.h"

#include <cmath>
#include <numbers>
#include <random>

using namespace lrsm;

namespace {

struct NoStep {};

/// A floor of 2 m, its upper side in a plane of voxel centres, under a sun straight above; a blocker high above keeps it from x < 0.
struct SunlitFloor {
    static constexpr float kAlbedo = 0.5f, kSun = 8.0f;
    Scene scene;
    Settings settings;
    Requirements needs;
    OpacityPyramid opacity;
    std::vector<Rsm> rsms;
    GBuffer nothing;

    explicit SunlitFloor(CacheShadow shadow)
    {
        scene.materials = {diffuseMaterial("grey", Vec3(kAlbedo), true)};
        scene.meshes.resize(2);
        addQuad(scene.meshes[0], {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
        addQuad(scene.meshes[1], {-1, 0.8f, 1}, {0, 0.8f, 1}, {0, 0.8f, -1}, {-1, 0.8f, -1});
        scene.lights = {directionalLight(Vec3(0, -1, 0), Vec3(kSun))};
        scene.cameras = {lookAt({0, 3, 3}, {0, 0, 0}, {0, 1, 0}, 0.8f)};
        updateBounds(scene);
        settings.caches.fill = CacheFill::voxels;
        settings.caches.shadow = shadow;
        settings.voxel.resolution = 32;
        settings.rsm.resolution = 128;
        needs = analyseRequirements(scene, {});
        opacity = buildPyramid(voxelize(scene, settings.voxel), settings.voxel);
        rsms = {renderRsm(scene, scene.lights[0], needs, settings.rsm)};
    }
    IsotropicVolume lit() const
    {
        const GatherInput input{
            .scene = scene, .camera = scene.cameras[0], .needs = needs, .settings = settings, .gbuffer = nothing, .rsms = rsms, .opacity = opacity};
        return lightVoxels(input, voxelSurface(scene, opacity.base, settings.voxel, TextureFilter::trilinear));
    }
};

/// A cache in the middle of a random isotropic volume of 16^3.
struct RandomVoxels {
    IsotropicVolume volume;
    VoxelGrid grid{.origin = Vec3(-1.0f, 2.0f, 0.5f), .voxelSize = 0.25f, .resolution = 16};
    CachePlaces places;

    RandomVoxels()
    {
        std::mt19937 random(11);
        std::uniform_real_distribution<float> unit(0.0f, 1.0f);
        BitGrid bits;
        bits.grid = grid;
        bits.bricks.assign(predictBitGridBytes(16) / sizeof(std::uint64_t), 0);
        for (std::uint64_t& brick : bits.bricks)
            for (int bit = 0; bit < 64; ++bit)
                if (unit(random) < 0.1f) brick |= std::uint64_t(1) << bit;
        volume.preExposure = 4.0f;
        volume.maps = mapBricks(bits);
        std::vector<Vec4>& base = volume.levels.emplace_back(volume.maps[0].texelCount(), Vec4(0.0f));
        for (std::size_t place = 1; place < volume.maps[0].coordinate.size(); ++place)
            for (std::size_t bit = 0; bit < 64; ++bit)
                if (bits.bricks[volume.maps[0].coordinate[place]] >> bit & 1u) base[place * 64 + bit] = Vec4(unit(random), unit(random), unit(random), 1.0f);
        prefilterRadiance(volume, {.storage = Storage::float32});
        places = test::placesOf({glm::normalize(Vec3(0.2f, 0.9f, -0.4f))});
        places.positions = {Vec3(1.03f, 3.98f, 2.51f)};
    }
    CacheAtlas fill(const ConeSettings& cones, StepOpacity opacity, const CacheSettings& settings) const
    {
        return fillFromVoxels(places, makeCacheTables(settings, Rotation::none), {.volume = volume, .grid = grid, .cones = cones, .opacity = opacity},
                              settings);
    }
};

Settings smallFill(CacheFill fill)
{
    Settings settings = preset(fill == CacheFill::voxels ? "caches-paper" : "caches");
    settings.voxel.resolution = 32;
    settings.rsm.resolution = 128;
    settings.caches.fill = fill;
    settings.caches.tile = 16;
    settings.caches.resolution = 8;
    return settings;
}

Frame renderFill(const Scene& scene, const Settings& settings, int width, int height)
{
    RenderOptions options;
    options.width = width;
    options.height = height;
    return renderFrame(scene, scene.cameras.at(0), settings, options);
}

double meanGreen(const Image<Vec3>& image)
{
    double sum = 0.0;
    for (const Vec3& texel : image.texels) sum += double(texel.y);
    return sum / double(image.texels.size());
}

}  // namespace

TEST_CASE("rc_fill=voxels: d = 3/4 + 2 t tan h, steps of d/2 after a first of half a step, and log2 d grows by one constant", "[caches]")
{
    const float tanHalf = texelTanHalf(16, 1.0f);
    const MarchSchedule schedule = voxelSchedule(tanHalf, 200.0f, 1024);
    CHECK(std::log2(1.0 + double(tanHalf)) == Approx(0.1225).margin(1e-4));  // cos h = 1 - 1/N^2
    REQUIRE(schedule.steps.size() > 30);
    CHECK(schedule.steps.front().middle == 0.1875f);
    CHECK(schedule.steps.back().middle < 200.0f);
    CHECK(schedule.steps.back().end >= 200.0f);
    double t = 0.1875;
    for (const MarchStep& step : schedule.steps) {
        const double d = 0.75 + 2.0 * t * double(tanHalf);
        CHECK(double(step.middle) == Approx(t).epsilon(1e-6));
        CHECK(double(step.diameter) == Approx(d).epsilon(1e-6));
        CHECK(double(step.end - step.begin) == Approx(0.5 * d).epsilon(1e-5));
        CHECK(double(step.level) == Approx(std::max(0.0, std::log2(d))).margin(1e-6));
        CHECK(double(step.tapWidth) == Approx(std::max(1.0, d)).epsilon(1e-6));
        t += 0.5 * d;
    }
    CHECK(voxelSchedule(tanHalf, 200.0f, 7).steps.size() == 7);
}

TEST_CASE("rc_fill=voxels: a texel is the sum of T rgb over samples, front to back, against the closed schedule in double", "[caches]")
{
    const RandomVoxels world;
    ConeSettings cones;
    cones.march.transmittance = TransmittanceModel::exponential;
    cones.march.transmittanceCutoff = 0.0f;
    cones.set.apertureScale = 1.0f;
    const CacheSettings settings{.fill = CacheFill::voxels, .resolution = 8, .storage = Storage::float32};
    const CacheAtlas atlas = world.fill(cones, StepOpacity::none, settings);
    const CacheTables tables = makeCacheTables(settings, Rotation::none);
    const IsotropicLookup lookUp(world.volume, FilterFraction::exact);
    const double tanHalf = std::tan(std::acos(1.0 - 1.0 / 64.0)), d1 = 0.75 + 0.375 * tanHalf;
    const Vec3 origin = world.grid.voxelsFromWorld(world.places.positions[0] + world.places.normals[0] * (cones.march.normalOffsetVoxels * 0.25f));
    std::size_t lit = 0;
    for (std::size_t i = 0; i < 64; ++i) {
        const Vec3 direction = basisFromNormal(world.places.normals[0]) * tables.directions[i];
        glm::dvec3 radiance(0.0);
        double transmittance = 1.0;
        for (int k = 0; k < 60; ++k) {
            const double d = d1 * std::pow(1.0 + tanHalf, k), t = (d - 0.75) / (2.0 * tanHalf);
            if (t > 16.0 * std::numbers::sqrt3) break;
            const Vec4 sample = lookUp(origin + direction * float(t), float(std::max(0.0, std::log2(d))));
            radiance += transmittance * glm::dvec3(sample);
            transmittance *= 1.0 - double(sample.w);
        }
        for (int c = 0; c < 3; ++c) REQUIRE(double(atlas.levels[0][i][c]) == Approx(radiance[c]).margin(2e-5));
        REQUIRE(double(atlas.levels[0][i].w) == Approx(1.0 - transmittance).margin(2e-5));
        lit += atlas.levels[0][i].x > 0.0f ? 1 : 0;
    }
    CHECK(lit > 40);
    CHECK(atlas.cones.cones == 64);
}

TEST_CASE("rc_fill=voxels: a furnace, all voxels L, gives each texel its opacity's share of L, by every way of summing", "[caches]")
{
    RandomVoxels world;
    for (std::vector<Vec4>& level : world.volume.levels)
        for (Vec4& texel : level) texel = Vec4(Vec3(2.0f) * texel.w, texel.w);
    ConeSettings cones;
    cones.march.transmittance = GENERATE(TransmittanceModel::exponential, TransmittanceModel::linear);
    const StepOpacity opacity = GENERATE(StepOpacity::none, StepOpacity::step);
    const CacheAtlas atlas = world.fill(cones, opacity, {.fill = CacheFill::voxels, .resolution = 8, .storage = Storage::float32});
    for (const Vec4& texel : atlas.levels[0]) REQUIRE(texel.x == Approx(2.0f * texel.w).epsilon(double(kVctMarchMaxError)));
}

TEST_CASE("rc_fill=voxels: a lit voxel is albedo L <n.l> / pi, one in shadow dark, by cone or map", "[caches]")
{
    const SunlitFloor floor(GENERATE(CacheShadow::cone, CacheShadow::rsm));
    const IsotropicVolume volume = floor.lit();
    const BitGrid& bits = floor.opacity.base;
    const double full = double(SunlitFloor::kAlbedo * SunlitFloor::kSun) / std::numbers::pi;
    const int edge = int(bits.grid.voxelsFromWorld(Vec3(0.0f)).x);
    int lit = 0, dark = 0;
    const int y = int(std::floor(bits.grid.voxelsFromWorld(Vec3(0.0f)).y));
    for (int z = 4; z < 28; ++z)
        for (int x = 4; x < 28; ++x) {
            if (!bits.occupied(x, y, z) || std::abs(x - edge) < 3) continue;  // the shadow's rim
            const Vec4 texel = volume.levels[0][volume.maps[0].texel(x, y, z)];
            CHECK(texel.w == 1.0f);
            CHECK(double(texel.x / volume.preExposure) == Approx(x > edge ? full : 0.0).epsilon(2e-3).margin(1e-6));
            (x > edge ? lit : dark) += 1;
        }
    CHECK(lit > 100);
    CHECK(dark > 100);
}

TEST_CASE("rc_fill=vct: with a cache a pixel the picture is that of as many cones a pixel of method vct", "[caches]")
{
    const auto scene = makeBuiltinScene("cornell-box");
    Settings caches = smallFill(CacheFill::vct);
    caches.voxel.resolution = 64;
    caches.caches.resolution = 16;
    caches.caches.tile = 1;
    caches.caches.radius = 0.5f;
    Settings cones = caches;
    cones.method = Method::vct;
    cones.cones.set.count = 256;
    CHECK(meanGreen(renderFill(*scene, caches, 16, 12).irradiance) == Approx(meanGreen(renderFill(*scene, cones, 16, 12).irradiance)).epsilon(0.02));
}

TEST_CASE("rc_fill: builds what it reads, holds what it predicts, and has the same bits for any number of threads", "[caches]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    const CacheFill fill = GENERATE(CacheFill::vct, CacheFill::voxels);
    const Settings settings = smallFill(fill);
    const Frame frame = renderFill(*scene, settings, 48, 36);
    std::vector<std::string> names;
    for (const PassReport& pass : frame.passes) names.push_back(pass.name);
    if (fill == CacheFill::vct)
        CHECK(names == std::vector<std::string>{"voxelize", "rsm 0", "gbuffer", "direct", "rc clusters", "rc places", "vct inject", "vct mips", "rc fill",
                                                "rc convolve", "rc gather", "composite"});
    else
        CHECK(names == std::vector<std::string>{"voxelize", "voxel mips", "rsm 0", "gbuffer", "direct", "rc clusters", "rc places", "vct surface", "rc light",
                                                "rc mips", "rc fill", "rc convolve", "rc gather", "composite"});
    MemoryQuestion question{.scene = *scene, .needs = frame.needs, .settings = settings, .width = 48, .height = 36};
    question.rendered = &frame.passes;
    std::vector<MemoryRow> rows = predictMemory(question);
    addMeasured(rows, frame.passes);
    for (const MemoryRow& row : rows) {
        CAPTURE(row.structure);
        REQUIRE(row.measured);
        CHECK(*row.measured == row.predicted);
    }
    const ThreadLimit one(1);
    const Frame again = renderFill(*scene, settings, 48, 36);
    for (std::size_t i = 0; i < names.size(); ++i) CHECK(again.passes[i].sha256 == frame.passes[i].sha256);
    CHECK(meanGreen(frame.irradiance) > 0.0);
}
