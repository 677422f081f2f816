#include "conetrace/frame/direct.h"

#include "core/base/parallel.h"
#include "core/scene/brdf.h"
#include "tests/conetrace/frame/direct_scene.h"
#include "voxel/voxelize.h"

#include "catch.h"

using namespace lrsm;

namespace {

constexpr double kPiOfDirect = 3.14159265358979323846;
OpacityPyramid voxels(const Scene& scene, OpacityAxes axes)
{
    VoxelSettings settings;
    settings.resolution = 64;
    settings.axes = axes;
    return buildPyramid(voxelize(scene, settings), settings);
}

DirectSettings shadowsOf(Shadows mode)
{
    DirectSettings settings;
    settings.shadows = mode;
    return settings;
}

}  // namespace

TEST_CASE("direct light: without shadows each pixel is albedo / pi times irradiance times cosine, summed over lights", "[conetrace][direct]")
{
    Scene scene = directScene();
    scene.lights = {testLight(0), testLight(1)};
    const GBuffer g = renderGBuffer(scene, directCamera(), kDirectNeeds, {96, 54});
    const DirectResult direct = traceDirect(g, scene, directCamera(), {}, nullptr, kDirectNeeds, shadowsOf(Shadows::off));
    for (std::size_t i = 0; i < g.objectId.texels.size(); ++i) {
        glm::dvec3 expected(0.0);
        if (g.covered(i))
            for (const Light& light : scene.lights) {
                const LightSample s = sampleLight(light, g.position.texels[i]);
                const double cosine = glm::dot(glm::dvec3(g.normal.texels[i]), glm::dvec3(s.toLight));
                if (glm::dot(g.geometricNormal.texels[i], s.toLight) > 0)
                    expected += glm::dvec3(g.albedo.texels[i]) * glm::dvec3(s.irradiance) * std::max(0.0, cosine) / kPiOfDirect;
            }
        for (int k = 0; k < 3; ++k) REQUIRE(direct.radiance.texels[i][k] == Approx(expected[k]).epsilon(1e-5).margin(1e-6));
    }
}

TEST_CASE("direct light: a surface's own specular lobe is added, and left out when not needed", "[conetrace][direct]")
{
    Scene scene = directScene();
    for (Material& material : scene.materials) material.roughness = 0.4f;
    scene.lights = {testLight(0)};
    const Camera camera = directCamera();
    Requirements need;
    const GBuffer g = renderGBuffer(scene, camera, need, {64, 36});
    const DirectResult with = traceDirect(g, scene, camera, {}, nullptr, need, shadowsOf(Shadows::off));
    need.specular = false;
    const DirectResult without = traceDirect(g, scene, camera, {}, nullptr, need, shadowsOf(Shadows::off));
    int brighter = 0;
    for (std::size_t i = 0; i < g.objectId.texels.size(); ++i) {
        if (!g.covered(i)) continue;
        Surface surface;
        surface.normal = g.normal.texels[i];
        surface.specularColor = g.specularColor.texels[i];
        surface.roughness = g.roughness.texels[i];
        const Vec3 toEye = glm::normalize(camera.position - g.position.texels[i]), toLight = -scene.lights[0].direction;
        Vec3 expected = without.radiance.texels[i];
        if (expected != Vec3(0.0f)) expected += scene.lights[0].intensity * evaluateSpecular(surface, toLight, toEye);
        for (int k = 0; k < 3; ++k) REQUIRE(with.radiance.texels[i][k] == Approx(expected[k]).epsilon(1e-5));
        brighter += with.radiance.texels[i].x > without.radiance.texels[i].x;
    }
    CHECK(brighter > 500);
}

TEST_CASE("shadow cones: open ground is lit, ground under a wide roof is dark", "[conetrace][direct]")
{
    const OpacityAxes axes = GENERATE(OpacityAxes::isotropic, OpacityAxes::directional);
    Scene scene;
    Mesh floor, roof;
    addQuad(floor, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
    addQuad(roof, {-3, 2, 3}, {0, 2, 3}, {0, 2, -3}, {-3, 2, -3});
    addMesh(scene, floor, Vec3(0.5f), false);
    addMesh(scene, roof, Vec3(0.5f), true);
    updateBounds(scene);
    const OpacityPyramid opacity = voxels(scene, axes);
    const float tanHalf = 0.0175f;
    const auto at = [&](float x) { return shadowFromCone(opacity, {x, 0, 0}, {0, 1, 0}, {0, 1, 0}, kInfinity, tanHalf); };
    CHECK(at(-1.5f) < 0.05f);
    CHECK(at(2.0f) == 1.0f);
    // A light below the roof is not shadowed by it.
    CHECK(shadowFromCone(opacity, {-1.5f, 0, 0}, {0, 1, 0}, {0, 1, 0}, 1.5f, tanHalf) == 1.0f);
    // Slanted light: the shadow moves with it.
    const Vec3 toLight = glm::normalize(Vec3(-1, 1, 0));
    CHECK(shadowFromCone(opacity, {0.5f, 0, 0}, {0, 1, 0}, toLight, kInfinity, tanHalf) < 0.1f);
    CHECK(shadowFromCone(opacity, {-2.5f, 0, 0}, {0, 1, 0}, toLight, kInfinity, tanHalf) == 1.0f);
    // A wider cone sees past the edge: a penumbra.
    const float soft = shadowFromCone(opacity, {0.0f, 0, 0}, {0, 1, 0}, {0, 1, 0}, kInfinity, 0.35f);
    CHECK((soft > 0.05f && soft < 0.95f));
}

TEST_CASE("direct light: any number of threads gives the same bits", "[conetrace][direct]")
{
    Scene scene = directScene();
    scene.lights = {testLight(0), testLight(1)};
    const std::vector<Rsm> maps = renderMaps(scene, 128);
    const OpacityPyramid opacity = voxels(scene, OpacityAxes::directional);
    const GBuffer g = renderGBuffer(scene, directCamera(), kDirectNeeds, {160, 90});
    for (const Shadows mode : {Shadows::exact, Shadows::hard, Shadows::pcf, Shadows::cone}) {
        std::vector<DirectResult> results;
        for (const int threads : {1, 2, 8}) {
            const ThreadLimit limit(threads);
            results.push_back(traceDirect(g, scene, directCamera(), depthsOf(maps), &opacity, kDirectNeeds, shadowsOf(mode)));
        }
        CHECK(results[0].radiance.texels == results[1].radiance.texels);
        CHECK(results[0].radiance.texels == results[2].radiance.texels);
    }
}

TEST_CASE("direct light: intensity times 2^k gives exactly 2^k times the radiance", "[conetrace][direct][invariance]")
{
    Scene scene = directScene();
    scene.lights = {testLight(1)};
    const std::vector<Rsm> maps = renderMaps(scene, 128);
    const GBuffer g = renderGBuffer(scene, directCamera(), kDirectNeeds, {64, 36});
    const DirectResult one = traceDirect(g, scene, directCamera(), depthsOf(maps), nullptr, kDirectNeeds, shadowsOf(Shadows::hard));
    scene.lights[0].intensity *= 4096.0f;
    const DirectResult scaled = traceDirect(g, scene, directCamera(), depthsOf(maps), nullptr, kDirectNeeds, shadowsOf(Shadows::hard));
    for (std::size_t i = 0; i < one.radiance.texels.size(); ++i) REQUIRE(scaled.radiance.texels[i] == 4096.0f * one.radiance.texels[i]);
}
