#include "conetrace/proxies/places.h"

#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "tests/conetrace/proxies/proxy_scenes.h"

#include "catch.h"

#include <cmath>

using namespace lrsm;
using namespace lrsm::test;

namespace {

double areaOf(const Scene& scene)
{
    double area = 0.0;
    for (const Mesh& mesh : scene.meshes)
        for (const auto& t : mesh.triangles) {
            const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
            area += 0.5 * glm::length(glm::cross(b - a, c - a));
        }
    return area;
}

}  // namespace

TEST_CASE("proxies: a triangle's count is N A_i / A in the mean, by either hash, and never a whole one off", "[proxies]")
{
    const double expected = GENERATE(0.0, 0.125, 0.3, 1.0, 2.75);
    constexpr std::uint32_t kTriangles = 20000;
    double byIndex = 0.0, byPlace = 0.0;
    for (std::uint32_t i = 0; i < kTriangles; ++i) {
        const Aabb reach{Vec3(-1.0f), Vec3(3.0f)};
        const double one = proxyCount(expected, indexHash(3, i));
        REQUIRE((one >= std::floor(expected) && one <= std::ceil(expected)));
        byIndex += one;
        byPlace += proxyCount(expected, placeHash({double(i % 100) * 0.01, double(i / 100) * 0.01, 0.5}, reach));
    }
    const double fraction = expected - std::floor(expected), deviation = std::sqrt(fraction * (1.0 - fraction) / kTriangles);
    CHECK(std::abs(byIndex / kTriangles - expected) <= 4.0 * deviation);
    CHECK(std::abs(byPlace / kTriangles - expected) <= 4.0 * deviation);
}

TEST_CASE("proxies: their areas sum to the scene's, and each quad has its share", "[proxies]")
{
    for (const char* name : {"cornell-box", "atrium", "furnace"}) {
        const Scene scene = *makeBuiltinScene(name);
        const ProxySettings settings{.count = 20000};
        const PointProxies proxies = placeProxies(scene, settings, TextureFilter::trilinear);
        const double area = areaOf(scene);
        CAPTURE(name);
        CHECK(double(proxies.area) == Approx(area / settings.count).epsilon(1e-5));
        // Roulette: a Bernoulli trial a triangle, of variance 1/4 at most.
        CHECK(std::abs(double(proxies.size()) - settings.count) <= 4.0 * 0.5 * std::sqrt(double(scene.triangleCount())));
    }
}

TEST_CASE("proxies: points lie on their triangles, as evenly as a Halton sequence", "[proxies]")
{
    const Scene scene = quadScene({{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 0, -1), Vec3(0, 0, -1)}});
    const PointProxies proxies = placeProxies(scene, {.count = 4000}, TextureFilter::trilinear);
    REQUIRE(proxies.size() == 4000);
    glm::dvec3 mean(0.0);
    std::vector<int> tiles(32, 0);
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        const Vec3 p = proxies.positions[i];
        REQUIRE((p.x >= 0.0f && p.x <= 2.0f && p.y == 0.0f && p.z <= 0.0f && p.z >= -1.0f));
        REQUIRE(proxies.normals[i] == Vec3(0, 1, 0));
        mean += glm::dvec3(p) / 4000.0;
        ++tiles[std::size_t(std::min(7, int(p.x * 4.0f)) * 4 + std::min(3, int(-p.z * 4.0f)))];
    }
    CHECK(glm::length(mean - glm::dvec3(1.0, 0.0, -0.5)) < 2e-3);
    for (const int count : tiles) CHECK(std::abs(count - 125) <= 12);
    // The sequence's first elements, by hand.
    CHECK(halton(1, 2) == 0.5);
    CHECK(halton(6, 2) == 0.375);
    CHECK(halton(5, 3) == Approx(7.0 / 9.0));
}

TEST_CASE("proxies: a ground that leads out of the reach is cut there", "[proxies]")
{
    Scene scene = quadScene({{Vec3(-1000, 0, 1000), Vec3(1000, 0, 1000), Vec3(1000, 0, -1000), Vec3(-1000, 0, -1000)}});
    scene.reach = {Vec3(-1, -1, -1), Vec3(1, 1, 1)};
    const PointProxies proxies = placeProxies(scene, {.count = 1000}, TextureFilter::trilinear);
    CHECK(double(proxies.area) == Approx(4.0 / 1000));
    CHECK(std::abs(double(proxies.size()) - 1000.0) <= 8.0);
    for (const Vec3& p : proxies.positions) REQUIRE((std::abs(p.x) <= 1.0f && std::abs(p.z) <= 1.0f));
}

TEST_CASE("proxies: only the side that a light reaches shines, by albedo E cos / pi, in the map's shadow none", "[proxies]")
{
    // A floor under a sun, half of it below a roof; a wall that is lit from behind.
    Scene scene =
        quadScene({{Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(1, 0, -1), Vec3(-1, 0, -1)}, {Vec3(-1, 1, 1), Vec3(0, 1, 1), Vec3(0, 1, -1), Vec3(-1, 1, -1)}}, true);
    const float cosine = 0.8f;
    scene.lights = {directionalLight(Vec3(0.0f, 1.0f, 0.0f), Vec3(4.0f))};  // from below: floor and roof are lit on their backs
    const bool fromBelow = GENERATE(true, false);
    if (!fromBelow) scene.lights = {directionalLight(glm::normalize(Vec3(0.0f, -cosine, -0.6f)), Vec3(4.0f))};
    Settings settings;
    settings.proxies.count = 4000;
    settings.proxies.storage = Storage::float32;
    settings.rsm.resolution = 512;
    const Requirements needs = analyseRequirements(scene, {});
    const std::vector<Rsm> rsms = {renderRsm(scene, scene.lights[0], needs, settings.rsm)};
    const PointProxies proxies = placeProxies(scene, settings.proxies, TextureFilter::trilinear);
    const ProxyLight light =
        lightProxies({.scene = scene, .camera = scene.cameras[0], .needs = needs, .settings = settings, .gbuffer = {}, .rsms = rsms, .opacity = {}}, proxies);
    const double expected = 0.5 * 4.0 * (fromBelow ? 1.0 : double(cosine)) / double(kPi);
    constexpr float kMapTexels = 0.02f;
    std::size_t lit = 0, dark = 0;
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        const Vec3 p = proxies.positions[i];
        // Where the roof's shadow falls: seen from the light the lower one of two.
        const float shift = fromBelow ? 0.0f : 0.75f;
        const bool below = fromBelow ? p.y > 0.5f : p.y < 0.5f && p.x < 0.0f && p.z > -1.0f - shift + 0.0f && p.z < 1.0f - shift;
        const bool nearEdge = std::abs(p.x) < kMapTexels || std::abs(p.z - (1.0f - shift)) < kMapTexels || std::abs(std::abs(p.x) - 1.0f) < kMapTexels ||
                              std::abs(std::abs(p.z) - 1.0f) < kMapTexels;
        if (nearEdge) continue;
        if (below) {
            CHECK(light.radiance[i] == Vec3(0.0f));
            ++dark;
        } else {
            CHECK(double(light.radiance[i].y) == Approx(expected).epsilon(1e-4));
            CHECK(light.normals[i].y == (fromBelow ? -1.0f : 1.0f));
            ++lit;
        }
    }
    CHECK(lit > 1000);
    CHECK(dark > 500);
}
