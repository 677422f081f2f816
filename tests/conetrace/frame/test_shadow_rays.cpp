#include "conetrace/frame/shadow_rays.h"

#include "core/base/parallel.h"
#include "core/base/rng.h"
#include "tests/conetrace/frame/direct_scene.h"

#include "catch.h"

using namespace lrsm;

namespace {

/// Rays by brute force in double, from the same origins: the first face in the way whose front, or whose double side, looks at the light.
bool litByRay(const Scene& scene, const Light& light, const Vec3& p, const Vec3& n)
{
    const Vec3 largest = glm::max(glm::abs(scene.bounds.min), glm::abs(scene.bounds.max)), a = glm::abs(p);
    const float offset = kShadowRayOffset * std::max({a.x, a.y, a.z}) + kShadowRaySceneOffset * std::max({largest.x, largest.y, largest.z});
    const glm::dvec3 origin(p + n * offset);
    const bool directional = light.type == LightType::directional;
    const glm::dvec3 to = directional ? -glm::dvec3(light.direction) : glm::dvec3(light.position) - origin;
    // Backs are culled as a ray from the light meets them.
    const oracle::RayHit hit =
        directional ? oracle::closestHit(scene, origin + to * 1e4, -to, 0.0, true) : oracle::closestHit(scene, origin + to, -to, 0.0, true);
    return hit.mesh < 0 || hit.t >= (directional ? 1e4 : 1.0);
}

struct Disagreement {
    int lit = 0, dark = 0, wrong = 0;
};
Disagreement againstRays(const Scene& scene, const Light& light, const Camera& camera, int width, int height)
{
    const GBuffer g = renderGBuffer(scene, camera, kDirectNeeds, {width, height});
    const Image<std::uint8_t> visibility = traceShadowRays(scene, g, light, kDirectNeeds);
    Disagreement found;
    for (std::size_t i = 0; i < g.objectId.texels.size(); ++i) {
        const Vec3 p = g.position.texels[i], n = g.geometricNormal.texels[i];
        const LightSample sample = sampleLight(light, p);
        if (!g.covered(i) || sample.irradiance == Vec3(0.0f) || glm::dot(n, sample.toLight) <= 0.0f || glm::dot(g.normal.texels[i], sample.toLight) <= 0.0f) {
            CHECK(visibility.texels[i] == 1);  // the light does not arrive anyway
            continue;
        }
        const bool expected = litByRay(scene, light, p, n);
        (expected ? found.lit : found.dark) += 1;
        found.wrong += expected != (visibility.texels[i] == 1);
    }
    return found;
}

/// Triangles of all sizes and turns, half of them single-sided, in a room around the light.
Scene soup(std::uint32_t seed, int count)
{
    Scene scene;
    Mesh room, sheets, singles;
    addBox(room, Vec3(-4), Vec3(4), true);
    for (int i = 0; i < count; ++i) {
        const auto a = philox({std::uint32_t(i), 0, 0, 0}, {seed, 1}), b = philox({std::uint32_t(i), 1, 0, 0}, {seed, 1});
        const auto in = [](std::uint32_t word) { return 2.0f * unitFloat(word) - 1.0f; };
        const Vec3 centre = 3.0f * Vec3(in(a[0]), in(a[1]), in(a[2])), u = Vec3(in(b[0]), in(b[1]), in(b[2])) * (a[3] % 8 == 0 ? 2.0f : 0.3f);
        const Vec3 v(u.y, -u.z, u.x);
        Mesh& mesh = i % 2 ? sheets : singles;
        const auto first = std::uint32_t(mesh.positions.size());
        for (const Vec3& p : {centre, centre + u, centre + v}) {
            mesh.positions.push_back(p);
            mesh.normals.push_back(glm::normalize(glm::cross(u, v)));
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    addMesh(scene, room, Vec3(0.5f), false);
    addMesh(scene, sheets, Vec3(0.5f), true);
    addMesh(scene, singles, Vec3(0.5f), false);
    updateBounds(scene);
    return scene;
}

}  // namespace

TEST_CASE("shadow rays: equal to rays cast by brute force", "[conetrace][shadows]")
{
    const int kind = GENERATE(0, 1);
    const Disagreement found = againstRays(directScene(), testLight(kind), directCamera(), 160, 90);
    CAPTURE(kind, found.lit, found.dark);
    CHECK(found.lit > 4000);
    CHECK(found.dark > 300);
    CHECK(found.wrong == 0);
}

TEST_CASE("shadow rays: any triangles, around and behind a light, both kinds of sides", "[conetrace][shadows]")
{
    const std::uint32_t seed = GENERATE(1u, 2u, 3u);
    const Scene scene = soup(seed, 150);
    const Camera camera = lookAt({3.5f, 3.2f, 3.4f}, {-1, -1, -1}, {0, 1, 0}, 1.6f);
    std::vector<Light> lights = splitPointLight({0.1f, 0.2f, -0.1f}, Vec3(1), kInfinity, "bulb");
    lights.push_back(spotLight({2, 3, 2}, {0, -1, 0}, Vec3(1), 1.2f, 1.5f));
    lights.push_back(directionalLight(glm::normalize(Vec3(-0.3f, -1, 0.2f)), Vec3(1)));
    Disagreement all;
    for (const Light& light : lights) {
        const Disagreement found = againstRays(scene, light, camera, 64, 40);
        all = {all.lit + found.lit, all.dark + found.dark, all.wrong + found.wrong};
    }
    CAPTURE(seed, all.lit, all.dark);
    CHECK(all.lit > 500);
    CHECK(all.dark > 300);
    CHECK(all.wrong == 0);
}

TEST_CASE("shadow rays: no light between the two triangles of a square, on their very diagonal", "[conetrace][shadows]")
{
    Scene scene;
    Mesh floor, roof;
    addQuad(floor, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
    addQuad(roof, {-8, 2, 8}, {8, 2, 8}, {8, 2, -8}, {-8, 2, -8});
    addMesh(scene, floor, Vec3(0.5f), false);
    addMesh(scene, roof, Vec3(0.5f), true);
    updateBounds(scene);
    // From above, a picture whose pixels' centres lie on the diagonals.
    const Camera camera = lookAt({0, 1.5f, 0}, {0, 0, 0}, {0, 0, -1}, 1.0f);
    const GBuffer g = renderGBuffer(scene, camera, kDirectNeeds, {65, 65});
    for (const Light& light : {directionalLight({0, -1, 0}, Vec3(1)), spotLight({0, 4, 0}, {0, 0, 0}, Vec3(1), 1.0f, 1.2f)}) {
        const Image<std::uint8_t> visibility = traceShadowRays(scene, g, light, kDirectNeeds);
        CHECK(std::count(visibility.texels.begin(), visibility.texels.end(), 1) == 0);
    }
}

TEST_CASE("shadow rays: an alpha mask lets light through its holes", "[conetrace][shadows]")
{
    Scene scene;
    Mesh floor, grid;
    addQuad(floor, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
    addQuad(grid, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1}, {-1, 1, -1});
    grid.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    addMesh(scene, floor, Vec3(0.5f), false);
    addMesh(scene, grid, Vec3(0.5f), true);
    Texture holes;
    holes.nearest = true;
    holes.image = Image<Rgba8>(4, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) holes.image.at(x, y).a = (x + y) % 2 ? 0 : 255;
    scene.textures = {std::make_shared<Texture>(holes)};
    scene.materials[1].alphaMask = true;
    scene.materials[1].baseColorTexture.texture = 0;
    updateBounds(scene);
    const GBuffer g = renderGBuffer(scene, lookAt({0, 0.5f, 0}, {0, 0, 0}, {0, 0, -1}, 2.0f), kDirectNeeds, {64, 64});
    Requirements needs;
    const Image<std::uint8_t> visibility = traceShadowRays(scene, g, directionalLight({0, -1, 0}, Vec3(1)), needs);
    int holesSeen = 0;
    for (std::size_t i = 0; i < visibility.texels.size(); ++i) {
        const Vec3 p = g.position.texels[i];
        const int x = int(std::floor((p.x + 1) * 2)), y = int(std::floor((p.z + 1) * 2));
        if (!g.covered(i) || std::abs(p.x * 2 - std::round(p.x * 2)) < 1e-4f || std::abs(p.z * 2 - std::round(p.z * 2)) < 1e-4f) continue;
        CHECK(int(visibility.texels[i]) == ((x + y) % 2 ? 1 : 0));
        holesSeen += visibility.texels[i];
    }
    CHECK(holesSeen > 500);
    // Without the test the sheet is solid.
    needs.alphaTest = false;
    const Image<std::uint8_t> solid = traceShadowRays(scene, g, directionalLight({0, -1, 0}, Vec3(1)), needs);
    CHECK(std::count(solid.texels.begin(), solid.texels.end(), 1) == 0);
}

TEST_CASE("shadow rays: millimetres, kilometres and a sun that is a far lamp", "[conetrace][shadows]")
{
    const float scale = GENERATE(1e-3f, 1.0f, 4096.0f);
    Scene scene = directScene();
    for (Mesh& mesh : scene.meshes)
        for (Vec3& p : mesh.positions) p *= scale;
    updateBounds(scene);
    Camera camera = directCamera();
    camera.position *= scale;
    camera.nearPlane *= scale;
    const Vec3 from = glm::normalize(Vec3(-0.35f, 1, 0.2f));
    for (const float distance : {8.0f, 1e5f}) {
        const Light light = spotLight(from * (distance * scale), {0, 0, 0}, Vec3(1), 0.9f, 1.0f);
        const Disagreement found = againstRays(scene, light, camera, 96, 54);
        CAPTURE(scale, distance, found.lit, found.dark);
        CHECK(found.dark > 100);
        CHECK(found.wrong == 0);
    }
}
