#include "lrsm/rsm.h"

#include "core/base/parallel.h"
#include "core/scene/shapes.h"

#include "catch.h"

#include <cstring>

using namespace lrsm;

namespace {

constexpr double kPiDouble = 3.14159265358979323846;
const Requirements kEverything;

/// Floor y = 0 of +-size metres, albedo rho.
Scene floorScene(float size, const Vec3& rho, bool doubleSided = false)
{
    Scene scene;
    scene.materials.push_back(diffuseMaterial("floor", rho, doubleSided));
    Mesh mesh;
    addQuad(mesh, {-size, 0, size}, {size, 0, size}, {size, 0, -size}, {-size, 0, -size});
    scene.meshes.push_back(mesh);
    updateBounds(scene);
    return scene;
}

Scene roomScene()
{
    Scene scene = floorScene(4, Vec3(0.8f, 0.5f, 0.25f), true);
    Mesh box;
    addBox(box, Vec3(-1, 0, -1), Vec3(0.5f, 1.3f, 0.2f));
    scene.meshes.push_back(box);
    Mesh ball;
    addSphere(ball, Vec3(1.5f, 1, 1), 0.8f, 3);
    scene.meshes.push_back(ball);
    updateBounds(scene);
    return scene;
}

RsmSettings settingsOf(int resolution, Storage storage)
{
    RsmSettings settings;
    settings.resolution = resolution;
    settings.storage = storage;
    return settings;
}

}  // namespace

TEST_CASE("RSM: a floor under a slanted sun reflects rho E cos / pi everywhere, at the depth of its distance along the axis", "[lrsm][rsm][eq2]")
{
    const Vec3 direction = glm::normalize(Vec3(0.3f, -1, 0.5f)), irradiance(2, 3, 5), rho(0.2f, 0.5f, 0.9f);
    const Rsm rsm = renderRsm(floorScene(3, rho), directionalLight(direction, irradiance), kEverything, settingsOf(64, Storage::float32));
    const LightProjection& q = rsm.projection;
    int covered = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const RsmTexel& texel = rsm.texels.at(x, y);
            if (texel.coverage == 0.0f) {
                REQUIRE(texel.radiance == Vec3(0.0f));
                REQUIRE(rsm.depthLinear.at(x, y) == 1.0f);
                continue;
            }
            ++covered;
            REQUIRE(texel.nDotL == Approx(-direction.y));
            for (int k = 0; k < 3; ++k) REQUIRE(texel.radiance[k] == Approx(rho[k] * irradiance[k] * -direction.y / kPiDouble));
            const Vec3 onNear = q.position + q.right * ((float(x) + 0.5f) / 32 - 1) * q.halfWidth + q.up * (1 - (float(y) + 0.5f) / 32) * q.halfWidth;
            const float along = -onNear.y / direction.y;                                       // to the floor
            REQUIRE(rsm.depthLinear.at(x, y) == Approx(along / q.depthRange()).margin(1e-3));  // vertices move by up to 1/512 texel
        }
    // The floor's area seen along the axis, in texels.
    CHECK(covered == Approx(36 * -direction.y / std::pow(q.halfWidth / 32, 2)).epsilon(0.02));
}

TEST_CASE("RSM: intensity times 2^k gives exactly 2^k times the radiance", "[lrsm][rsm][invariance]")
{
    Light light = spotLight({1, 4, 2}, {0, 0, 0}, Vec3(5, 3, 2), 0.2f, 0.7f);
    const Rsm one = renderRsm(roomScene(), light, kEverything, settingsOf(128, Storage::float32));
    light.intensity *= 1024.0f;
    const Rsm scaled = renderRsm(roomScene(), light, kEverything, settingsOf(128, Storage::float32));
    for (std::size_t i = 0; i < one.texels.texels.size(); ++i) {
        REQUIRE(scaled.texels.texels[i].radiance == 1024.0f * one.texels.texels[i].radiance);
        REQUIRE(scaled.depthLinear.texels[i] == one.depthLinear.texels[i]);
    }
}

TEST_CASE("RSM: gpu storage holds the float32 map rounded to half, saturations counted", "[lrsm][rsm][formats]")
{
    const HalfRounding rounding = GENERATE(HalfRounding::d3d, HalfRounding::nearestEven);
    const Light light = spotLight({1, 4, 2}, {0, 0, 0}, Vec3(5e7f, 3, 2e-4f), 0.2f, 0.7f);
    RsmSettings settings = settingsOf(64, Storage::float32);
    const Rsm exact = renderRsm(roomScene(), light, kEverything, settings);
    settings.storage = Storage::gpu;
    settings.halfRounding = rounding;
    const Rsm stored = renderRsm(roomScene(), light, kEverything, settings);

    std::uint64_t saturated = 0;
    for (std::size_t i = 0; i < exact.texels.texels.size(); ++i) {
        const RsmTexel &a = exact.texels.texels[i], &b = stored.texels.texels[i];
        const auto half = [&](float v) { return floatFromHalf(halfFromFloat(std::min(v, 65504.0f), rounding)); };
        for (int k = 0; k < 3; ++k) {
            REQUIRE(b.radiance[k] == half(a.radiance[k]));
            REQUIRE(b.normal[k] == half(a.normal[k]));
            saturated += a.radiance[k] > 65504.0f;
        }
        REQUIRE(b.nDotL == half(a.nDotL));
        REQUIRE(b.coverage == a.coverage);
        REQUIRE(stored.depthLinear.texels[i] == exact.depthLinear.texels[i]);
    }
    CHECK(saturated > 100);
    CHECK(stored.conversions.halfSaturations >= saturated);
    CHECK(exact.conversions.halfSaturations == 0);
}

TEST_CASE("RSM: single-sided surfaces are seen from their front only, double-sided ones face the light", "[lrsm][rsm]")
{
    const Light above = directionalLight({0, -1, 0}, Vec3(1)), below = directionalLight({0, 1, 0}, Vec3(1));
    const auto centre = [&](const Light& light, bool doubleSided) {
        return renderRsm(floorScene(1, Vec3(0.5f), doubleSided), light, kEverything, settingsOf(32, Storage::float32)).texels.at(15, 15);
    };
    CHECK(centre(above, false).coverage == 1.0f);
    CHECK(centre(below, false).coverage == 0.0f);
    CHECK(centre(above, true).normal == Vec3(0, 1, 0));
    CHECK(centre(below, true).normal == Vec3(0, -1, 0));
    CHECK(centre(below, true).radiance.x == Approx(0.5 / kPiDouble));
}

TEST_CASE("RSM: geometry very near a light inside the scene is drawn", "[lrsm][rsm]")
{
    Scene scene = floorScene(10, Vec3(0.5f));
    const Light light = spotLight({0, 0.01f, 0}, {0, 0, 0}, Vec3(1), 0.4f, 0.8f);  // a centimetre above a 20 m floor
    const Rsm rsm = renderRsm(scene, light, kEverything, settingsOf(32, Storage::float32));
    for (const RsmTexel& texel : rsm.texels.texels) REQUIRE(texel.coverage == 1.0f);
}

TEST_CASE("RSM: masked surfaces let the light through", "[lrsm][rsm]")
{
    Scene scene = floorScene(2, Vec3(0.5f));
    Mesh roof;
    addQuad(roof, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1});
    roof.material = 1;
    scene.meshes.push_back(roof);
    scene.materials.push_back(diffuseMaterial("mask", Vec3(1)));
    scene.materials[1].alphaMask = true;
    updateBounds(scene);
    const Light sun = directionalLight({0, -1, 0}, Vec3(1));
    const auto centreDepth = [&] { return renderRsm(scene, sun, kEverything, settingsOf(32, Storage::gpu)).depthLinear.at(16, 16); };
    scene.materials[1].baseColor.a = 0.75f;
    CHECK(centreDepth() == Approx(0).margin(1e-6));
    scene.materials[1].baseColor.a = 0.25f;
    CHECK(centreDepth() == Approx(1).margin(1e-6));
}

TEST_CASE("RSM: an empty scene and a light that sees nothing give an empty, finite map", "[lrsm][rsm]")
{
    const Scene empty;
    Scene behind = floorScene(1, Vec3(0.5f));
    for (const Scene& scene : {empty, behind})
        for (const Light& light : {spotLight({0, 3, 0}, {0, 5, 0}, Vec3(1), 0.1f, 0.5f), directionalLight({0, 1, 0}, Vec3(1))}) {
            const Rsm rsm = renderRsm(scene, light, kEverything, settingsOf(16, Storage::gpu));
            for (const RsmTexel& texel : rsm.texels.texels) REQUIRE((texel.coverage == 0.0f && texel.radiance == Vec3(0.0f) && texel.nDotL == 0.0f));
            for (const float depth : rsm.depthLinear.texels) REQUIRE(depth == 1.0f);
        }
}

TEST_CASE("RSM: predicted bytes are the measured ones, any number of threads gives the same bits", "[lrsm][rsm]")
{
    const Light light = spotLight({1, 4, 2}, {0, 0, 0}, Vec3(5, 3, 2), 0.2f, 0.7f);
    std::vector<Rsm> maps;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        maps.push_back(renderRsm(roomScene(), light, kEverything, settingsOf(256, Storage::gpu)));
    }
    CHECK(bytesOf(maps[0]) == Rsm::predictBytes(256));
    for (const Rsm& map : maps) {
        CHECK(std::memcmp(map.texels.texels.data(), maps[0].texels.texels.data(), map.texels.byteSize()) == 0);
        CHECK(map.depthLinear.texels == maps[0].depthLinear.texels);
        CHECK(map.conversions.halfSaturations == maps[0].conversions.halfSaturations);
    }
}
