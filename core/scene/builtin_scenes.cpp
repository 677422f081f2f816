#include "core/scene/builtin_scenes.h"

#include "core/base/elementary.h"
#include "core/scene/light.h"
#include "core/scene/shapes.h"

#include <array>

// The Cornell box is the measured data of the Cornell University Program of Computer Graphics
// (https://www.graphics.cornell.edu/online/box/data.html), millimetres turned to metres; its three reflectance spectra as the linear Rec. 709
// values in common use (McGuire's archive). The area lamp is replaced by a spot at its centre, since LRSM lights are points.

namespace lrsm {
namespace {

constexpr float kDegree = kPi / 180.0f;
constexpr Vec3 kWhite(0.725f, 0.71f, 0.68f), kRed(0.63f, 0.065f, 0.05f), kGreen(0.14f, 0.45f, 0.091f);

/// Starts a mesh of its own material in the scene.
Mesh& addMesh(Scene& scene, const Material& material)
{
    scene.materials.push_back(material);
    Mesh mesh;
    mesh.name = material.name;
    mesh.material = static_cast<int>(scene.materials.size()) - 1;
    scene.meshes.push_back(mesh);
    return scene.meshes.back();
}

Scene cornellBox(const Material& tallBlockMaterial)
{
    Scene scene;
    const auto mm = [](float x, float y, float z) { return 0.001f * Vec3(x, y, z); };

    Mesh& shell = addMesh(scene, diffuseMaterial("white", kWhite, true));
    addQuad(shell, mm(552.8f, 0, 0), mm(0, 0, 0), mm(0, 0, 559.2f), mm(549.6f, 0, 559.2f));                      // floor
    addQuad(shell, mm(556.0f, 548.8f, 0), mm(556.0f, 548.8f, 559.2f), mm(0, 548.8f, 559.2f), mm(0, 548.8f, 0));  // ceiling
    addQuad(shell, mm(549.6f, 0, 559.2f), mm(0, 0, 559.2f), mm(0, 548.8f, 559.2f), mm(556.0f, 548.8f, 559.2f));  // back
    addQuad(addMesh(scene, diffuseMaterial("green", kGreen, true)), mm(0, 0, 559.2f), mm(0, 0, 0), mm(0, 548.8f, 0), mm(0, 548.8f, 559.2f));
    addQuad(addMesh(scene, diffuseMaterial("red", kRed, true)), mm(552.8f, 0, 0), mm(549.6f, 0, 559.2f), mm(556.0f, 548.8f, 559.2f), mm(556.0f, 548.8f, 0));

    const std::array<Vec2, 4> shortBlock = {0.001f * Vec2(130, 65), 0.001f * Vec2(82, 225), 0.001f * Vec2(240, 272), 0.001f * Vec2(290, 114)};
    const std::array<Vec2, 4> tallBlock = {0.001f * Vec2(423, 247), 0.001f * Vec2(265, 296), 0.001f * Vec2(314, 456), 0.001f * Vec2(472, 406)};
    addPrism(addMesh(scene, diffuseMaterial("short block", kWhite)), shortBlock, 0.0f, 0.165f);
    addPrism(addMesh(scene, tallBlockMaterial), tallBlock, 0.0f, 0.330f);

    // The lamp's quad spans x 213-343, z 227-332 at the ceiling.
    scene.lights.push_back(spotLight(mm(278, 540, 279.5f), mm(278, 0, 279.5f), Vec3(1.0f), 50.0f * kDegree, 65.0f * kDegree));
    // 35 mm focal length, 25 mm film: 2 atan(12.5 / 35).
    scene.cameras.push_back(lookAt(mm(278, 273, -800), mm(278, 273, 0), Vec3(0, 1, 0), 0.6860253f));
    return scene;
}

Scene glossyCornellBox()
{
    Material metal = diffuseMaterial("glossy metal", Vec3(0.9f));
    metal.metallic = 1.0f;
    metal.roughness = 0.25f;
    return cornellBox(metal);
}

/// Two closed rooms of 4 x 3 x 4 m; the divider is 4 cm thick, thinner than a voxel at 128^3. Truth in the right room: no light at all.
Scene twoRooms()
{
    Scene scene;
    // Single-sided walls facing inward: the camera outside looks through the front.
    addBox(addMesh(scene, diffuseMaterial("walls", Vec3(0.7f))), Vec3(-4, 0, -2), Vec3(4, 3, 2), true);
    addBox(addMesh(scene, diffuseMaterial("divider", Vec3(0.7f, 0.5f, 0.3f))), Vec3(-0.02f, 0, -2), Vec3(0.02f, 3, 2));
    addBox(addMesh(scene, diffuseMaterial("crate", Vec3(0.2f, 0.4f, 0.7f))), Vec3(-3.2f, 0, -1.2f), Vec3(-2.2f, 1, -0.2f));
    addBox(addMesh(scene, diffuseMaterial("crate right", Vec3(0.2f, 0.4f, 0.7f))), Vec3(2.2f, 0, -1.2f), Vec3(3.2f, 1, -0.2f));
    scene.lights.push_back(spotLight(Vec3(-2, 2.9f, 0), Vec3(-1.6f, 0, 0), Vec3(20.0f), 40.0f * kDegree, 50.0f * kDegree));
    scene.cameras.push_back(lookAt(Vec3(0, 1.6f, 8.5f), Vec3(0, 1.45f, 0), Vec3(0, 1, 0), 36.0f * kDegree));
    return scene;
}

/// An open court between two colonnades, thin curtains between the columns, sun from above.
Scene atrium()
{
    Scene scene;
    Mesh& stone = addMesh(scene, diffuseMaterial("stone", Vec3(0.62f, 0.58f, 0.5f), true));
    addQuad(stone, Vec3(-10, 0, 5), Vec3(10, 0, 5), Vec3(10, 0, -5), Vec3(-10, 0, -5));  // floor
    addQuad(stone, Vec3(-10, 0, -5), Vec3(10, 0, -5), Vec3(10, 6, -5), Vec3(-10, 6, -5));
    addQuad(stone, Vec3(10, 0, 5), Vec3(-10, 0, 5), Vec3(-10, 6, 5), Vec3(10, 6, 5));
    addQuad(stone, Vec3(-10, 0, 5), Vec3(-10, 0, -5), Vec3(-10, 6, -5), Vec3(-10, 6, 5));
    addQuad(stone, Vec3(10, 0, -5), Vec3(10, 0, 5), Vec3(10, 6, 5), Vec3(10, 6, -5));
    addBox(stone, Vec3(-10, 4, -5), Vec3(10, 4.4f, -2.5f));  // gallery floors over the aisles
    addBox(stone, Vec3(-10, 4, 2.5f), Vec3(10, 4.4f, 5));

    Mesh& columns = addMesh(scene, diffuseMaterial("columns", Vec3(0.7f, 0.68f, 0.64f)));
    for (int i = 0; i < 6; ++i)
        for (const float z : {-2.8f, 2.8f}) addColumn(columns, Vec3(-8.0f + 3.2f * float(i), 0.0f, z), 0.3f, 4.0f, 16);

    static constexpr std::array<Vec3, 3> kCurtains = {Vec3(0.6f, 0.06f, 0.05f), Vec3(0.08f, 0.35f, 0.1f), Vec3(0.07f, 0.1f, 0.5f)};
    for (int i = 0; i < 5; ++i) {
        const float x = -8.0f + 3.2f * float(i);
        addQuad(addMesh(scene, diffuseMaterial("curtain " + std::to_string(i), kCurtains[std::size_t(i) % 3], true)), Vec3(x + 0.5f, 1.2f, 2.6f),
                Vec3(x + 2.7f, 1.2f, 2.6f), Vec3(x + 2.7f, 4, 2.6f), Vec3(x + 0.5f, 4, 2.6f));
    }
    scene.lights.push_back(directionalLight(Vec3(0.25f, -1.0f, 0.55f), Vec3(10.0f)));
    scene.cameras.push_back(lookAt(Vec3(-9, 1.7f, -1.2f), Vec3(5, 2.0f, 1.2f), Vec3(0, 1, 0), 60.0f * kDegree));
    return scene;
}

/// Inside of a sphere of radius 1 m with a point light at its centre: every point receives the same direct light head-on, so outgoing radiance is
/// the constant rho I / pi and the indirect irradiance is rho I = 0.5 W/m^2 everywhere.
Scene furnace()
{
    Scene scene;
    addSphere(addMesh(scene, diffuseMaterial("sphere", Vec3(0.5f))), Vec3(0.0f), 1.0f, 5, true);
    scene.lights = splitPointLight(Vec3(0.0f), Vec3(1.0f), kInfinity, "point");
    scene.cameras.push_back(lookAt(Vec3(0.0f), Vec3(0.3f, 0.2f, -1.0f), Vec3(0, 1, 0), 70.0f * kDegree));
    return scene;
}

}  // namespace

std::vector<BuiltinSceneInfo> builtinScenes()
{
    return {{"cornell-box", "the measured Cornell box, lit by a spot in place of its lamp"},
            {"cornell-glossy", "the same with a glossy metal tall block: specular cones"},
            {"two-rooms", "two closed rooms with a thin divider, lit on the left only: leaks show on the right"},
            {"atrium", "an open court with columns and thin curtains under the sun"},
            {"furnace", "inside of a sphere lit from its centre: irradiance 0.5 W/m^2 everywhere"}};
}

std::optional<Scene> makeBuiltinScene(const std::string& name)
{
    Scene scene;
    if (name == "cornell-box")
        scene = cornellBox(diffuseMaterial("tall block", kWhite));
    else if (name == "cornell-glossy")
        scene = glossyCornellBox();
    else if (name == "two-rooms")
        scene = twoRooms();
    else if (name == "atrium")
        scene = atrium();
    else if (name == "furnace")
        scene = furnace();
    else
        return std::nullopt;
    scene.name = name;
    updateBounds(scene);
    return scene;
}

}  // namespace lrsm
