#include "conetrace/caches/gather.h"

#include "conetrace/frame/receiver.h"
#include "conetrace/lrsm/march_slab.h"
#include "conetrace/render.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "core/settings/settings_table.h"
#include "tests/conetrace/caches/surfaces.h"
#include "voxel/voxelize.h"

#include "catch.h"

#include <cstdio>
#include <numbers>

using namespace lrsm;

namespace {

Settings smallCaches()
{
    Settings settings = preset("caches");
    settings.voxel.resolution = 64;
    settings.rsm.resolution = 128;
    settings.caches.tile = 16;
    settings.caches.resolution = 8;
    return settings;
}

Frame renderSmall(const Scene& scene, const Settings& settings, int lanes = 0)
{
    RenderOptions options;
    options.width = 48;
    options.height = 36;
    options.lanes = lanes;
    return renderFrame(scene, scene.cameras.at(0), settings, options);
}

std::vector<std::string> hashesOf(const Frame& frame)
{
    std::vector<std::string> all;
    for (const PassReport& pass : frame.passes) all.push_back(pass.name + " " + pass.sha256);
    return all;
}

double mean(const Image<Vec3>& image)
{
    double sum = 0.0;
    for (const Vec3& texel : image.texels) sum += double(texel.x + texel.y + texel.z);
    return sum / double(image.texels.size());
}

/// Of the difference, over the mean of `b`.
double difference(const Image<Vec3>& a, const Image<Vec3>& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        const glm::dvec3 d = glm::dvec3(a.texels[i]) - glm::dvec3(b.texels[i]);
        sum += glm::dot(d, d);
    }
    return std::sqrt(sum / double(a.texels.size()) / 3.0) / (mean(b) / 3.0);
}

/// What a recorder of the march is told is kept: none.
struct Nothing : NoRecorder {};

}  // namespace

TEST_CASE("method caches: the same bits for any number of threads and any width", "[caches]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    const Settings settings = smallCaches();
    const std::vector<std::string> all = hashesOf(renderSmall(*scene, settings));
    CHECK(all == hashesOf(renderSmall(*scene, settings, 4)));
    const ThreadLimit one(1);
    CHECK(all == hashesOf(renderSmall(*scene, settings)));
}

TEST_CASE("method caches: a furnace, caches that all see L, gives every pixel pi L and every lobe L", "[caches]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    const Requirements needs = analyseRequirements(*scene, {});
    const GBuffer g = renderGBuffer(*scene, scene->cameras[0], needs, {64, 48});
    CacheSettings settings{.tile = 8, .resolution = 8, .radius = 2.0f, .minCosine = -1.0f, .horizon = CacheHorizon::renormalise, .storage = Storage::float32};
    settings.mapping = GENERATE(CacheMapping::equalArea, CacheMapping::octahedral);
    const PixelClusters clusters = clusterPixels(g, scene->cameras[0], settings);
    const CachePlaces places = placeCaches(g, scene->cameras[0], clusters, settings, Rotation::none);
    CacheAtlas atlas;
    atlas.resolution = settings.resolution;
    atlas.preExposure = 4.0f;
    atlas.levels.emplace_back(places.size() * 64, Vec4(Vec3(2.0f), 1.0f));
    atlas = convolveCaches(std::move(atlas), makeCacheTables(settings, Rotation::none), settings);
    const Gathered light =
        evaluateCaches({.gbuffer = g, .camera = scene->cameras[0], .clusters = clusters, .places = places, .atlas = atlas, .settings = settings}, needs);
    std::size_t glossy = 0;
    for (std::size_t i = 0; i < g.objectId.texels.size(); ++i) {
        if (!g.covered(i)) continue;
        REQUIRE(double(light.irradiance.texels[i].y) == Approx(0.5 * std::numbers::pi).epsilon(1e-5));
        REQUIRE(light.opacity.texels[i] == Approx(1.0f).epsilon(1e-5));
        if (light.specular.texels[i] == Vec3(0.0f)) continue;
        ++glossy;
        REQUIRE(light.specular.texels[i].y == Approx(0.5f).epsilon(1e-5));
    }
    CHECK(glossy > 200);
}

TEST_CASE("method caches: a pixel reads the caches within its radius and cosine, each with the lesser weight, against a search through all in double",
          "[caches]")
{
    const auto scene = makeBuiltinScene("atrium");
    const Requirements needs = analyseRequirements(*scene, {});
    const GBuffer g = renderGBuffer(*scene, scene->cameras[0], needs, {96, 54});
    const CacheSettings settings{.tile = 8, .radius = 1.5f, .minCosine = 0.5f};
    const PixelClusters clusters = clusterPixels(g, scene->cameras[0], settings);
    const CachePlaces places = placeCaches(g, scene->cameras[0], clusters, settings, Rotation::none);
    const CacheAtlas none;
    const CacheWorld world{.gbuffer = g, .camera = scene->cameras[0], .clusters = clusters, .places = places, .atlas = none, .settings = settings};
    const double radius = 12.0, metresAPixel = 2.0 * std::tan(0.5 * double(scene->cameras[0].verticalFov)) / g.height;
    std::size_t byWorld = 0, byScreen = 0;
    for (int y = 0; y < g.height; y += 3)
        for (int x = 0; x < g.width; x += 3) {
            const std::size_t pixel = g.position.index(x, y);
            if (!g.covered(pixel)) continue;
            std::vector<double> read(places.size(), 0.0);
            bool any = false;
            forCachesOf(world, x, y, [&](std::uint32_t cache, float weight) { read[cache] = double(weight); });
            std::vector<double> expected(places.size(), 0.0);
            for (std::size_t c = 0; c < places.size(); ++c) {
                const double dx = x - int(places.pixels[c]) % g.width, dy = y - int(places.pixels[c]) / g.width;
                const double away = glm::length(glm::dvec3(g.position.texels[pixel]) - glm::dvec3(places.positions[c]));
                const double worldRadius = radius * metresAPixel * double(g.depthLinear.texels[places.pixels[c]]);
                const double ww = 1.0 - away * away / (worldRadius * worldRadius), ws = 1.0 - (dx * dx + dy * dy) / (radius * radius);
                if (double(glm::dot(g.normal.texels[pixel], places.normals[c])) < 0.5 || !(std::min(ww, ws) > 0.0)) continue;
                expected[c] = std::min(ww, ws);
                (ww < ws ? byWorld : byScreen) += 1;
                any = true;
            }
            if (!any) expected[clusters.clusterOf.texels[pixel] - 1] = 1.0;
            for (std::size_t c = 0; c < places.size(); ++c) REQUIRE(std::abs(read[c] - expected[c]) < 1e-4);
        }
    CHECK(byWorld > 500);
    CHECK(byScreen > 100);
}

TEST_CASE("method caches: light about a direction is linear between levels, and comes from the texel that looks there", "[caches]")
{
    const GBuffer nothing;
    const Camera camera;
    const PixelClusters clusters;
    const CacheSettings settings{.resolution = 8, .mapping = GENERATE(CacheMapping::equalArea, CacheMapping::octahedral)};
    const Vec3 axis = glm::normalize(Vec3(0.3f, -0.5f, 0.7f));
    const CachePlaces places = test::placesOf({Vec3(0, 1, 0), axis});
    const CacheTables tables = makeCacheTables(settings, Rotation::none);
    CacheAtlas atlas;
    atlas.resolution = 8;
    for (int level = 0; level < 4; ++level) atlas.levels.emplace_back(2u * std::size_t((8 >> level) * (8 >> level)), Vec4(float(level)));
    const CacheWorld world{.gbuffer = nothing, .camera = camera, .clusters = clusters, .places = places, .atlas = atlas, .settings = settings};
    for (const float level : {0.0f, 0.25f, 1.5f, 2.75f, 3.0f}) CHECK(radianceOf(world, 1, axis, level).x == Approx(level));

    // Of the second cache, texel i alone is lit.
    for (std::size_t i = 0; i < 64; i += 5) {
        atlas.levels[0].assign(128, Vec4(0.0f));
        atlas.levels[0][64 + i] = Vec4(1.0f);
        CHECK(radianceOf(world, 1, basisFromNormal(axis) * tables.directions[i], 0.0f).x == Approx(1.0f).margin(1e-4));
        CHECK(radianceOf(world, 0, basisFromNormal(places.normals[0]) * tables.directions[i], 0.0f).x == 0.0f);
    }
}

TEST_CASE("method caches: a texel is what the slab march gives along it", "[caches]")
{
    const auto scene = makeBuiltinScene("cornell-box");
    Settings settings = smallCaches();
    settings.caches.storage = Storage::float32;
    const Requirements needs = analyseRequirements(*scene, {});
    const OpacityPyramid opacity = buildPyramid(voxelize(*scene, settings.voxel), settings.voxel);
    const std::vector<Lrsm> lrsms = {buildLrsm(renderRsm(*scene, scene->lights[0], needs, settings.rsm), settings.layers)};
    const GBuffer g = renderGBuffer(*scene, scene->cameras[0], needs, {48, 36});
    const NormalCdf phi(settings.cones.gather.gaussian, settings.cones.gather.gaussianTableSize);
    const ConeWorld world{.opacity = opacity, .lrsms = lrsms, .settings = settings.cones, .phi = phi};
    const CacheTables tables = makeCacheTables(settings.caches, Rotation::strata);
    const CachePlaces places = placeCaches(g, scene->cameras[0], clusterPixels(g, scene->cameras[0], settings.caches), settings.caches, Rotation::strata);
    const CacheAtlas atlas = fillFromLrsm(places, tables, world, settings.caches);
    REQUIRE(atlas.caches() == places.size());

    const MarchSchedule schedule = texelSchedule(settings.caches, settings.cones, settings.voxel.resolution);
    const GenericSampler sampler{opacity, FilterFraction::exact};
    MarchScratch scratch;
    ConeCounts counts;
    Nothing nothing;
    std::size_t lit = 0;
    for (std::size_t i = 0; i < atlas.levels[0].size(); i += 7) {
        const std::size_t cache = i / 64;
        const auto x = int(places.pixels[cache]) % g.width, y = int(places.pixels[cache]) / g.width;
        const Receiver receiver = receiverAt(g, opacity.base.grid, settings.cones, x, y);
        const ConeRay ray = {.originWorld = receiver.originWorld,
                             .originVoxels = receiver.originVoxels,
                             .direction = basisFromNormal(receiver.geometricNormal) * tables.directions[places.rotations[cache] * 64 + i % 64],
                             .receiverNormal = receiver.geometricNormal};
        const ConeResult cone = marchSlab(world, sampler, ray, schedule, scratch, counts, nothing);
        REQUIRE(atlas.levels[0][i] == Vec4(cone.radiance, cone.opacity));
        lit += cone.radiance.x > 0.0f ? 1 : 0;
    }
    CHECK(lit > 100);
}

TEST_CASE("method caches: with a cache a pixel the picture is that of as many cones a pixel of method lrsm", "[caches]")
{
    const auto scene = makeBuiltinScene("cornell-box");
    Settings caches = smallCaches();
    caches.caches.resolution = 16;
    caches.caches.tile = 1;
    caches.caches.radius = 0.5f;
    Settings cones = caches;
    cones.method = Method::lrsm;
    cones.cones.set.count = 256;
    const Frame cached = renderSmall(*scene, caches), traced = renderSmall(*scene, cones);
    CHECK(mean(cached.irradiance) / mean(traced.irradiance) == Approx(1.0).margin(0.02));
    CHECK(difference(cached.irradiance, traced.irradiance) < 0.16);  // 256 directions of either set, through voxels of 64^3
}

TEST_CASE("method caches: holds what it predicts, and explains the pixel that it draws", "[caches]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    const Settings settings = smallCaches();
    RenderOptions options;
    options.width = 48;
    options.height = 36;
    const Frame frame = renderFrame(*scene, scene->cameras[0], settings, options);
    MemoryQuestion question{.scene = *scene, .needs = frame.needs, .settings = settings, .width = 48, .height = 36};
    question.rendered = &frame.passes;
    std::vector<MemoryRow> rows = predictMemory(question);
    addMeasured(rows, frame.passes);
    for (const MemoryRow& row : rows) {
        CAPTURE(row.structure);
        REQUIRE(row.measured);
        CHECK(*row.measured == row.predicted);
    }
    for (const PassReport& pass : frame.passes)
        if (pass.name == "rc convolve") {
            const std::size_t caches = std::size_t(counterSum(frame.passes, "caches"));
            CHECK(pass.gpuBytes == caches * 8 * (64 + 16 + 4 + 1 + 81));
        }

    const std::string text = explainPixel(*scene, scene->cameras[0], settings, options, 20, 30);
    char expected[128];
    const Vec3 e = frame.irradiance.at(20, 30);
    std::snprintf(expected, sizeof expected, "irradiance %.6g %.6g %.6g", double(e.x), double(e.y), double(e.z));
    CHECK(text.find(expected) != std::string::npos);
    CHECK(text.find("filled from the layered light maps") != std::string::npos);
    CHECK(text.find("w world") != std::string::npos);
    CHECK(text.find("tile 1,1") != std::string::npos);
    CHECK(text.find("specular: towards") != std::string::npos);
}
