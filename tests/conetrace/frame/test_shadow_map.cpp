#include "conetrace/frame/shadow_map.h"

#include "core/base/rng.h"
#include "tests/conetrace/frame/direct_scene.h"

#include "catch.h"

using namespace lrsm;

namespace {

constexpr float kBiasTexels = 0.75f;  // the default

Mesh convexShape(int kind, float size)
{
    Mesh mesh;
    if (kind == 0) addBox(mesh, Vec3(-0.5f, -0.3f, -0.2f) * size, Vec3(0.5f, 0.3f, 0.2f) * size);
    if (kind == 1) addSphere(mesh, Vec3(0.0f), 0.5f * size, 2);
    if (kind == 2) addQuad(mesh, Vec3(-1, 0, 1) * size, Vec3(1, 0, 1) * size, Vec3(1, 0, -1) * size, Vec3(-1, 0, -1) * size);
    return mesh;
}

/// Points spread over the faces that a light reaches.
std::vector<ShadowReceiver> litPoints(const Mesh& mesh, const Light& light, int perTriangle)
{
    std::vector<ShadowReceiver> points;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (int i = 0; i < perTriangle; ++i) {
            const auto words = philox({t, std::uint32_t(i), 0, 0}, {7, 7});
            float b1 = unitFloat(words[0]), b2 = unitFloat(words[1]);
            if (b1 + b2 > 1.0f) b1 = 1.0f - b1, b2 = 1.0f - b2;
            const auto& v = mesh.triangles[t];
            const Vec3 a = mesh.positions[v[0]], b = mesh.positions[v[1]], c = mesh.positions[v[2]];
            const ShadowReceiver point{a + b1 * (b - a) + b2 * (c - a), glm::normalize(glm::cross(b - a, c - a))};
            const LightSample sample = sampleLight(light, point.position);
            if (sample.irradiance != Vec3(0.0f) && glm::dot(point.geometricNormal, sample.toLight) > 0.0f) points.push_back(point);
        }
    return points;
}

}  // namespace

TEST_CASE("shadow maps: no convex surface shadows itself, at any angle, size and distance, without any bias", "[conetrace][shadows]")
{
    const int shape = GENERATE(0, 1, 2);
    const float size = GENERATE(0.01f, 1.0f, 3000.0f);
    std::size_t tested = 0;
    for (const float slant : {0.0f, 0.3f, 0.8f, 1.2f, 1.45f, 1.55f, 1.569f})
        for (const float distance : {0.0f, 1.3f, 6.0f, 100.0f}) {  // 0: directional
            Scene scene;
            addMesh(scene, convexShape(shape, size), Vec3(0.5f), false);
            updateBounds(scene);
            const Vec3 from = glm::normalize(Vec3(std::sin(slant), std::cos(slant), 0.3f * std::sin(slant)));
            const float halfAngle = std::min(1.2f, 2.0f / std::max(distance, 1.0f));
            const Light light =
                distance == 0.0f ? directionalLight(-from, Vec3(1)) : spotLight(from * (distance * size), {0, 0, 0}, Vec3(1), halfAngle, halfAngle);
            RsmSettings settings;
            settings.resolution = 64;
            const Rsm rsm = renderRsm(scene, light, kDirectNeeds, settings);
            int dark = 0, darkFiltered = 0;
            const std::vector<ShadowReceiver> points = litPoints(scene.meshes[0], light, shape == 1 ? 8 : 400);
            for (const ShadowReceiver& point : points) {
                dark += shadowFromMap(DepthMapView(rsm), point, 0.0f) != 1.0f;
                darkFiltered += shadowFromMapFiltered(DepthMapView(rsm), point, 0.0f, 3.0f) < 0.9999f;
            }
            tested += points.size();
            CAPTURE(shape, size, slant, distance, points.size());
            CHECK(dark == 0);
            CHECK(darkFiltered == 0);
        }
    CHECK(tested > 5000);
}

TEST_CASE("hard shadows: equal to ray-cast shadows but for a rim of texels", "[conetrace][shadows]")
{
    const int kind = GENERATE(0, 1), resolution = GENERATE(256, 1024);
    Scene scene = directScene();
    scene.lights = {testLight(kind)};
    const GBuffer g = renderGBuffer(scene, directCamera(), kDirectNeeds, {128, 72});
    const std::vector<Rsm> maps = renderMaps(scene, resolution);
    int lit = 0, dark = 0, acne = 0, leaks = 0;
    for (std::size_t i = 0; i < g.objectId.texels.size(); ++i) {
        if (!g.covered(i)) continue;
        const Vec3 p = g.position.texels[i], n = g.geometricNormal.texels[i];
        const LightSample sample = sampleLight(scene.lights[0], p);
        if (glm::dot(n, sample.toLight) <= 0.02f || sample.irradiance == Vec3(0.0f)) continue;
        const bool expected = litByRay(scene, sample, p, n);
        const float visibility = shadowFromMap(DepthMapView(maps[0]), {p, n}, kBiasTexels);
        (expected ? lit : dark) += 1;
        acne += expected && visibility != 1.0f;
        leaks += !expected && visibility != 0.0f;
    }
    CAPTURE(kind, resolution, lit, dark, acne, leaks);
    CHECK(lit > 3000);
    CHECK(dark > 200);
    CHECK(acne < (resolution == 256 ? 0.004 : 0.001) * lit);
    CHECK(leaks < (resolution == 256 ? 0.04 : 0.01) * dark);
}

TEST_CASE("depth maps: four times the texels in the RSM's frustum, the RSM's own depth at its texels", "[conetrace][shadows]")
{
    const int kind = GENERATE(0, 1);
    Scene scene = directScene();
    scene.lights = {testLight(kind)};
    const Rsm rsm = renderMaps(scene, 64)[0];
    CHECK(renderDepthMap(scene, scene.lights[0], kDirectNeeds, rsm.projection).depthLinear.texels == rsm.depthLinear.texels);
    // A finer map's texels about the centre of a coarse one enclose its depth, away from edges.
    const DepthMap fine = renderDepthMap(scene, scene.lights[0], kDirectNeeds, refine(rsm.projection, 4));
    REQUIRE(fine.depthLinear.width == 256);
    int near = 0, all = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            if (rsm.texels.at(x, y).coverage == 0.0f) continue;
            const float mean = 0.25f * (fine.depthLinear.at(4 * x + 1, 4 * y + 1) + fine.depthLinear.at(4 * x + 2, 4 * y + 1) +
                                        fine.depthLinear.at(4 * x + 1, 4 * y + 2) + fine.depthLinear.at(4 * x + 2, 4 * y + 2));
            near += std::abs(mean - rsm.depthLinear.at(x, y)) < 2e-4f;
            ++all;
        }
    CHECK(all > 1000);
    CHECK(near > 0.9 * all);
}

TEST_CASE("percentage-closer filtering: the mean of hard shadows over the square", "[conetrace][shadows]")
{
    const float width = GENERATE(1.0f, 2.0f, 5.5f);
    Scene scene = directScene();
    scene.lights = {testLight(0)};
    const std::vector<Rsm> maps = renderMaps(scene, 128);
    const DepthMapView map(maps[0]);
    const LightProjection& q = map.projection;
    const float texel = 2.0f * q.halfWidth / float(q.resolution);
    constexpr int kSteps = 24;
    int penumbra = 0;
    for (int i = 0; i < 400; ++i) {
        const ShadowReceiver p{Vec3(-3.0f + 6.0f * float(i % 20) / 19, 0, -2.0f + 5.0f * float(i / 20) / 19), Vec3(0, 1, 0)};
        double sum = 0.0;
        for (int sy = 0; sy < kSteps; ++sy)
            for (int sx = 0; sx < kSteps; ++sx) {
                // Moved across the light's axis, then along it back to the floor.
                const Vec3 across =
                    q.right * (texel * width * ((float(sx) + 0.5f) / kSteps - 0.5f)) + q.up * (texel * width * ((float(sy) + 0.5f) / kSteps - 0.5f));
                const Vec3 moved = p.position + across - q.forward * (across.y / q.forward.y);
                sum += double(shadowFromMap(map, {moved, p.geometricNormal}, kBiasTexels));
            }
        const float filtered = shadowFromMapFiltered(map, p, kBiasTexels, width);
        CHECK(filtered == Approx(sum / (kSteps * kSteps)).margin(0.09));
        penumbra += filtered > 0.05f && filtered < 0.95f;
    }
    CHECK(penumbra > 3);
}
