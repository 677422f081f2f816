#include "core/bvh/coincident.h"

#include "core/scene/shapes.h"
#include "reference/path_trace.h"

#include "catch.h"

using namespace lrsm;

namespace {

/// Two triangles on the same corners, the second turned by `rotation` of its corners and, if asked, wound the other way.
Scene pair(bool firstDoubleSided, bool laterDoubleSided, bool otherWinding, std::uint32_t rotation)
{
    Scene scene;
    scene.materials = {diffuseMaterial("first", Vec3(0.8f, 0.1f, 0.1f), firstDoubleSided), diffuseMaterial("later", Vec3(0.1f, 0.8f, 0.1f), laterDoubleSided)};
    for (int m = 0; m < 2; ++m) {
        Mesh& mesh = scene.meshes.emplace_back();
        mesh.material = m;
        mesh.positions = {Vec3(0, 0.0f, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.25f)};
        mesh.normals.assign(3, Vec3(0, 0, 1));
        mesh.triangles = {{0, 1, 2}};
    }
    scene.meshes[1].positions[0].y = -0.0f;
    std::array<std::uint32_t, 3>& later = scene.meshes[1].triangles[0];
    for (std::size_t k = 0; k < 3; ++k) later[k] = (std::uint32_t(k) + rotation) % 3;
    if (otherWinding) std::swap(later[0], later[1]);
    return scene;
}

}  // namespace

TEST_CASE("coincident: of triangles on the same corners the first stays, if it is seen wherever the later is", "[reference][coincident]")
{
    const std::uint32_t rotation = GENERATE(0u, 1u, 2u);
    for (const bool first : {false, true})
        for (const bool later : {false, true})
            for (const bool otherWinding : {false, true}) {
                INFO(first << later << otherWinding << " turned " << rotation);
                const Scene scene = pair(first, later, otherWinding, rotation);
                const bool hidden = first || (!later && !otherWinding);
                CHECK(hiddenTriangles(scene)[0].empty());
                CHECK(hiddenTriangles(scene)[1] == std::vector<std::uint8_t>(hidden ? 1 : 0, 1));
            }
}

TEST_CASE("coincident: what a mask may let through, what has no area and what is near stays", "[reference][coincident]")
{
    Scene masked = pair(true, true, false, 0);
    masked.materials[0].alphaMask = true;
    CHECK(hiddenTriangles(masked)[1].empty() == true);
    Scene behindMask = pair(true, true, false, 0);
    behindMask.materials[1].alphaMask = true;
    CHECK(hiddenTriangles(behindMask)[1].empty() == false);
    Scene near = pair(true, true, false, 0);
    near.meshes[1].positions[1].x = std::nextafter(1.0f, 2.0f);
    CHECK(hiddenTriangles(near)[1].empty() == true);
    Scene flat = pair(true, true, false, 0);
    for (Mesh& mesh : flat.meshes) mesh.triangles = {{0, 0, 1}};
    CHECK(hiddenTriangles(flat)[1].empty() == true);
}

TEST_CASE("coincident: eye and bounce meet the first of two quads in one, whichever Embree would find", "[reference][coincident]")
{
    // A floor of red and of green, and a white wall that it lights.
    const bool redFirst = GENERATE(true, false);
    Scene scene;
    scene.materials = {diffuseMaterial("red", Vec3(0.8f, 0, 0)), diffuseMaterial("green", Vec3(0, 0.8f, 0)), diffuseMaterial("white", Vec3(0.8f))};
    for (int m = 0; m < 3; ++m) scene.meshes.emplace_back().material = m;
    if (!redFirst) std::swap(scene.meshes[0].material, scene.meshes[1].material);
    for (std::size_t m = 0; m < 2; ++m) addQuad(scene.meshes[m], Vec3(-1, 0, 2), Vec3(1, 0, 2), Vec3(1, 0, 0), Vec3(-1, 0, 0));
    addQuad(scene.meshes[2], Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(1, 2, 0), Vec3(-1, 2, 0));
    scene.lights.push_back(directionalLight(Vec3(0, -1, -0.1f), Vec3(3.0f)));
    updateBounds(scene);
    const Camera camera = lookAt(Vec3(0, 1.2f, 4), Vec3(0, 0.8f, 0), Vec3(0, 1, 0), 0.7f);
    const ReferenceFrame frame = renderReference(scene, camera, {.width = 16, .height = 16}, 64);
    Vec3 floor(0.0f), wall(0.0f);
    for (std::size_t i = 0; i < frame.direct.texels.size(); ++i) {
        const Vec3& d = frame.direct.texels[i];
        (d.x == d.y ? wall : floor) += d.x == d.y ? frame.irradiance.texels[i] : d;
    }
    const int shown = redFirst ? 0 : 1;
    CHECK(floor[shown] > 0.0f);
    CHECK(floor[1 - shown] == 0.0f);
    CHECK(wall[shown] > 0.0f);
    CHECK(wall[1 - shown] == 0.0f);
}
