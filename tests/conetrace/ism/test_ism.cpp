#include "conetrace/ism/gather.h"

#include "conetrace/render.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "core/settings/settings_table.h"
#include "lrsm/texel_area.h"
#include "tests/conetrace/proxies/proxy_scenes.h"

#include "catch.h"

#include <cstdio>
#include <numeric>

using namespace lrsm;
using namespace lrsm::test;

namespace {

Settings smallIsm()
{
    Settings settings = preset("ism");
    settings.rsm.resolution = 128;
    settings.proxies.count = 8000;
    settings.ism.lights = 256;
    settings.ism.points = 2000;
    settings.ism.resolution = 32;
    return settings;
}

Frame renderSmall(const Scene& scene, const Settings& settings)
{
    RenderOptions options;
    options.width = 48;
    options.height = 36;
    return renderFrame(scene, scene.cameras.at(0), settings, options);
}

std::vector<Rsm> mapsOf(const Scene& scene, int resolution)
{
    const Requirements needs = analyseRequirements(scene, {});
    std::vector<Rsm> rsms;
    for (const Light& light : scene.lights) rsms.push_back(renderRsm(scene, light, needs, {.resolution = resolution}));
    return rsms;
}

std::vector<std::uint32_t> allOf(const PointProxies& points)
{
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

VirtualLight lightAt(const Vec3& position, const Vec3& normal)
{
    VirtualLight light;
    light.position = position;
    light.frame = basisFromNormal(normal);
    light.intensity = Vec3(1.0f);
    light.area = 0.01f;
    return light;
}

}  // namespace

TEST_CASE("imperfect maps: virtual lights carry the light of the maps, by importance exactly, evenly drawn ones in the mean", "[ism]")
{
    const Scene scene = *makeBuiltinScene("two-rooms");
    const std::vector<Rsm> rsms = mapsOf(scene, 256);
    double flux = 0.0;
    for (const Rsm& rsm : rsms)
        for (std::size_t i = 0; i < rsm.texels.texels.size(); ++i)
            if (rsm.texels.texels[i].coverage > 0.0f)
                flux += double(glm::dot(rsm.texels.texels[i].radiance, Vec3(0.2126f, 0.7152f, 0.0722f))) * double(texelArea(rsm, i));
    for (const IsmSampling sampling : {IsmSampling::importance, IsmSampling::uniform}) {
        const VirtualLights lights = drawLights(rsms, {.lights = 2000, .sampling = sampling});
        REQUIRE(lights.lights.size() == 2000);
        double sum = 0.0;
        for (const VirtualLight& light : lights.lights) sum += double(glm::dot(light.intensity, Vec3(0.2126f, 0.7152f, 0.0722f)));
        CHECK(sum == Approx(flux).epsilon(sampling == IsmSampling::importance ? 1e-4 : 0.05));
    }
    CHECK(drawLights({}, {}).lights.empty());
}

TEST_CASE("imperfect maps: unfilled, a texel holds the nearest of the points whose rays pass through it, in double", "[ism]")
{
    const Scene scene = *makeBuiltinScene("cornell-box");
    const PointProxies points = placeProxies(scene, {.count = 3000}, TextureFilter::trilinear);
    const Vec3 normal = glm::normalize(Vec3(0.3f, 1.0f, 0.2f)), from = scene.bounds.centre();
    const VirtualLight light = lightAt(from, normal);
    constexpr int kSize = 32;
    const std::vector<std::uint32_t> all = allOf(points);
    const std::vector<MapTexel> map = drawPoints(light, points, all, points.radius(), 1.0f, kSize, false);

    std::vector<double> expected(kSize * kSize, double(kInfinity));
    std::size_t onBorder = 0;
    for (const Vec3& p : points.positions) {
        const glm::dvec3 v = glm::dvec3(p) - glm::dvec3(from);
        const double distance = glm::length(v);
        const glm::dvec3 w = v / distance;
        const double z = glm::dot(w, glm::dvec3(light.frame[2]));
        if (z <= 1e-3 || distance <= 1.5 * double(points.radius())) continue;
        // The half vector of the paraboloid: (x, y) / (1 + z).
        const double u = (glm::dot(w, glm::dvec3(light.frame[0])) / (1.0 + z) * 0.5 + 0.5) * kSize,
                     v2 = (glm::dot(w, glm::dvec3(light.frame[1])) / (1.0 + z) * 0.5 + 0.5) * kSize;
        if (std::abs(u - std::round(u)) < 1e-4 || std::abs(v2 - std::round(v2)) < 1e-4) ++onBorder;
        double& texel = expected[std::size_t(int(v2) * kSize + int(u))];
        texel = std::min(texel, distance);
    }
    std::size_t holes = 0, wrong = 0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        holes += map[i].distance == kInfinity ? 1 : 0;
        const bool same =
            map[i].distance == kInfinity ? expected[i] == double(kInfinity) : std::abs(double(map[i].distance) - expected[i]) < 1e-4 * expected[i];
        wrong += same ? 0 : 1;
    }
    CHECK(wrong <= 2 * onBorder);
    CHECK(holes > 200);  // the corners of the square, which no hemisphere reaches, and gaps
    CHECK(holes < 800);
}

TEST_CASE("imperfect maps: filling is never nearer than the nearest point, fills only within reach of one, and hides what lies behind", "[ism]")
{
    // A floor below the light, and beneath it another one that shines through its gaps.
    const Scene scene =
        quadScene({{Vec3(-2, 0, 2), Vec3(2, 0, 2), Vec3(2, 0, -2), Vec3(-2, 0, -2)}, {Vec3(-2, -2, 2), Vec3(2, -2, 2), Vec3(2, -2, -2), Vec3(-2, -2, -2)}});
    const PointProxies points = placeProxies(scene, {.count = 3000}, TextureFilter::trilinear);
    const VirtualLight light = lightAt(Vec3(0.013f, 1, 0.007f), Vec3(0, -1, 0));
    constexpr int kSize = 64;
    const float reach = GENERATE(1.0f, 2.0f);
    const std::vector<std::uint32_t> all = allOf(points);
    const std::vector<MapTexel> drawn = drawPoints(light, points, all, points.radius(), reach, kSize, false);
    std::vector<MapTexel> filled = drawn;
    const std::uint64_t changed = pullPush(filled, kSize, 2.0f * points.radius());

    const auto nearest = [](const std::vector<MapTexel>& map) {
        float least = kInfinity;
        for (const MapTexel& texel : map) least = std::min(least, texel.distance);
        return least;
    };
    CHECK(nearest(filled) >= nearest(drawn));
    CHECK(changed > (reach > 1.5f ? 200 : 30));
    std::size_t upper = 0, lower = 0, seenThrough = 0;
    for (int row = 0; row < kSize; ++row)
        for (int column = 0; column < kSize; ++column) {
            const std::size_t i = std::size_t(row * kSize + column);
            const float u = float(column) + 0.5f, v = float(row) + 0.5f;
            if (filled[i].distance < kInfinity && filled[i].distance != drawn[i].distance) {
                CHECK(filled[i].distance < drawn[i].distance);
                bool within = false;
                for (const MapTexel& point : drawn)
                    within = within || (point.distance < kInfinity && std::hypot(point.u - u, point.v - v) <= 1.5f * point.reach + 1.0f);
                CHECK(within);
            }
            // Where the texel's ray meets the upper floor well inside: w from the paraboloid by x, y = 2 s / (1 + |s|^2).
            const double s = (double(u) / kSize * 2 - 1), t = (double(v) / kSize * 2 - 1), s2 = s * s + t * t;
            const double z = (1 - s2) / (1 + s2);
            if (z < 0.5) continue;
            const double floor = 1.0 / z;
            if (drawn[i].distance > floor * 1.5) ++seenThrough;
            if (filled[i].distance == kInfinity || filled[i].distance > floor * 1.5)
                ++lower;
            else {
                ++upper;
                CHECK(double(filled[i].distance) == Approx(floor).epsilon(0.15));
            }
        }
    CHECK(seenThrough > 20);
    CHECK(double(lower) < (reach > 1.5f ? 0.1 : 0.95) * double(seenThrough));
    CHECK(upper > 500);
}

TEST_CASE("imperfect maps: unshadowed, lights of a lit square give a facing one the closed form", "[ism]")
{
    Scene scene = quadScene({{Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, 0)}});
    scene.lights = {directionalLight(Vec3(0, -1, 0), Vec3(4.0f))};
    const std::vector<Rsm> rsms = mapsOf(scene, 512);
    const VirtualLights lights = drawLights(rsms, {.lights = 4096});
    ImperfectMaps maps;
    maps.resolution = 8;
    maps.range = 2.0f;
    maps.depth.assign(lights.lights.size() * maps.texels(), 1.0f);
    const GBuffer nothing;
    const IsmSettings settings;
    const VplSettings vpl;
    const IsmWorld world{.gbuffer = nothing, .camera = scene.cameras[0], .lights = lights, .maps = maps, .settings = settings, .vpl = vpl};
    double mean = 0.0, interleaved = 0.0;
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) {
            const Vec3 p((float(i) + 0.5f) / 8.0f, 1.0f, (float(j) + 0.5f) / 8.0f);
            mean += double(irradianceByLights(world, p, Vec3(0, -1, 0), 0, false).y) / 64.0;
            for (std::size_t first = 0; first < kInterleaved; ++first)
                interleaved += double(irradianceByLights(world, p, Vec3(0, -1, 0), first, true).y) / 64.0 / double(kInterleaved);
        }
    // Albedo 1/2 under 4 W/m^2: radiosity 2; factor of unit squares at distance 1: 0.19982 (Howell C-11).
    CHECK(mean == Approx(2.0 * 0.19982).epsilon(0.01));
    CHECK(interleaved == Approx(mean).epsilon(1e-4));
}

TEST_CASE("method ism: the same bits for any number of threads, memory as predicted, and --pixel ends with the pixel's irradiance", "[ism]")
{
    const auto scene = makeBuiltinScene("cornell-glossy");
    Settings settings = smallIsm();
    const Frame frame = renderSmall(*scene, settings);
    {
        const ThreadLimit one(1);
        const Frame again = renderSmall(*scene, settings);
        for (std::size_t i = 0; i < frame.passes.size(); ++i) CHECK(frame.passes[i].sha256 == again.passes[i].sha256);
    }
    std::vector<MemoryRow> rows = predictMemory({*scene, frame.needs, settings, 48, 36});
    addMeasured(rows, frame.passes);
    for (const MemoryRow& row : rows)
        if (row.pass.starts_with("ism")) CHECK(row.measured == row.predicted);

    settings.ism.interleave = false;
    const Vec3 e = renderSmall(*scene, settings).irradiance.at(20, 30);
    RenderOptions options;
    options.width = 48;
    options.height = 36;
    const std::string text = explainPixel(*scene, scene->cameras[0], settings, options, 20, 30);
    CHECK(text.find("256 virtual lights") != std::string::npos);
    char expected[128];
    std::snprintf(expected, sizeof expected, "irradiance (before the 4x4 filter) %.6g %.6g %.6g", double(e.x), double(e.y), double(e.z));
    CHECK(text.find(expected) != std::string::npos);
}

TEST_CASE("method ism: a wall between rooms keeps the lit one's light, if the maps' holes are filled", "[ism]")
{
    const auto scene = makeBuiltinScene("two-rooms");
    const auto leak = [&](IsmFill fill) {
        Settings settings = smallIsm();
        settings.ism.fill = fill;
        const Frame frame = renderSmall(*scene, settings);
        double left = 0.0, right = 0.0;
        for (int y = 0; y < 36; ++y)
            for (int x = 0; x < 48; ++x) (x > 27 ? right : left) += double(frame.irradiance.at(x, y).y);
        return right / left;
    };
    CHECK(leak(IsmFill::pullPush) < 0.04);
    CHECK(leak(IsmFill::none) > 2.0 * leak(IsmFill::pullPush));
}
