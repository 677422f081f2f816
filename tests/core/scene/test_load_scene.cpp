#include "core/base/errors.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/defaults.h"
#include "core/scene/load_scene.h"
#include "core/scene/view_file.h"

#include "catch.h"
#include "scenes.h"
#include "scratch.h"

using namespace lrsm;

namespace {

std::string loadError(const std::string& scene, const SceneOptions& options = {})
{
    try {
        loadScene(scene, options);
    } catch (const InputError& error) {
        return error.what();
    }
    return "(no error)";
}

}  // namespace

TEST_CASE("each built-in loads by name, and an unknown name lists them", "[scene][load]")
{
    REQUIRE_FALSE(builtinScenes().empty());
    const std::string error = loadError("no-such-scene");
    for (const BuiltinSceneInfo& info : builtinScenes()) {
        CHECK(loadScene(info.name, {}).triangleCount() > 0);
        CHECK(error.find(info.name) != std::string::npos);
    }
    CHECK(loadError("").find("built-in") != std::string::npos);
}

TEST_CASE("a view file replaces camera and lights, and the notes about defaults go", "[scene][view]")
{
    const ScratchFolder folder;
    folder.write("view.json", R"({"scene": "cornell-box", "camera": {"eye": [0, 1, 3], "target": [0, 1, 0], "verticalFovDegrees": 60},
        "lights": [{"type": "directional", "direction": [0, -2, 0], "color": [1, 0.5, 0], "intensity": 4}]})");
    for (const bool asScene : {true, false}) {
        const std::string view = folder.path("view.json");
        const Scene scene = asScene ? loadScene(view, {}) : loadScene("cornell-box", {0.0f, 0, view});
        REQUIRE(scene.cameras.size() == 1);
        CHECK(scene.cameras[0].position == Vec3(0, 1, 3));
        CHECK(scene.cameras[0].forward == Vec3(0, 0, -1));
        CHECK(scene.cameras[0].verticalFov == Approx(3.14159265 / 3));
        REQUIRE(scene.lights.size() == 1);
        CHECK(scene.lights[0].direction == Vec3(0, -1, 0));
        CHECK(scene.lights[0].intensity == Vec3(4, 2, 0));
        CHECK(std::abs(glm::dot(scene.lights[0].up, scene.lights[0].direction)) < 1e-6f);
        CHECK(glm::length(scene.lights[0].up) == Approx(1));
    }
}

TEST_CASE("a view file changes materials by name, with the textures that they would be multiplied by", "[scene][view]")
{
    const Scene before = loadScene("cornell-box", {});
    const std::string name = before.materials.at(0).name;
    const ScratchFolder folder;
    folder.write("view.json", R"({"scene": "cornell-box", "materials": [{"name": ")" + name + R"(", "roughness": 0.25, "metallic": 1},
        {"name": ")" + name + R"(", "baseColor": [0.1, 0.2, 0.3]}]})");
    const Scene scene = loadScene(folder.path("view.json"), {});
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const bool changed = before.materials[i].name == name;
        CHECK(scene.materials[i].roughness == (changed ? 0.25f : before.materials[i].roughness));
        CHECK(scene.materials[i].metallic == (changed ? 1.0f : before.materials[i].metallic));
        CHECK(scene.materials[i].baseColor == (changed ? Vec4(0.1f, 0.2f, 0.3f, before.materials[i].baseColor.a) : before.materials[i].baseColor));
    }

    Scene textured = before;
    for (TextureUse* use : {&textured.materials[0].baseColorTexture, &textured.materials[0].metallicRoughnessTexture}) use->texture = 0;
    changeMaterials(textured, {{.name = name, .roughness = 0.5f, .metallic = {}, .baseColor = {}}}, "here");
    CHECK(!textured.materials[0].metallicRoughnessTexture);
    CHECK(bool(textured.materials[0].baseColorTexture));

    folder.write("view.json", R"({"scene": "cornell-box", "materials": [{"name": "mirror", "roughness": 0}]})");
    CHECK(loadError(folder.path("view.json")).find("view.json: materials: the scene has no material \"mirror\"; it has ") != std::string::npos);
}

TEST_CASE("a view file's scene is relative to the view file, not to the working directory", "[scene][view]")
{
    LRSM_NEED_SCENES();
    for (const char* name : {"cornell.json", "sponza.json", "sibenik-nave.json"}) {
        const Scene scene = loadScene((scenesFolder() / "views" / name).string(), {});
        CHECK(scene.triangleCount() > 0);
        CHECK(scene.lights.size() == 1);
        CHECK(scene.cameras.size() == 1);
        for (const std::string& note : scene.notes) CHECK(note.find("in the file: ") == std::string::npos);
    }
}

TEST_CASE("every mistake in a view file is one line that names the key", "[scene][view]")
{
    const auto light = [](const std::string& fields) { return R"({"scene": "cornell-box", "lights": [{)" + fields + "}]}"; };
    struct Mistake {
        std::string text, mustSay;
    };
    const std::vector<Mistake> mistakes = {
        {"", "JSON"},
        {std::string(200, '['), "is nested more than 128 deep"},
        {"[]", "must be an object"},
        {"{\"scene\": ", "JSON"},
        {"{}", "scene: is missing"},
        {R"({"scene": 3})", "scene: must be a string"},
        {R"({"scene": "no-such.glb"})", "no-such.glb"},
        {R"({"scene": "view.json"})", "must not be a view file"},
        {R"({"scene": "cornell-box", "materials": [{"name": "a", "roughness": 2}]})", "roughness"},
        {R"({"scene": "cornell-box", "materials": [{"name": "a", "baseColor": [0, 0, 2]}]})", "baseColor"},
        {R"({"scene": "cornell-box", "materials": [{"name": "a", "colour": 2}]})", "unknown key"},
        {R"({"scene": "cornell-box", "cameras": []})", "unknown key \"cameras\""},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0, 0], "target": [0, 0, 0]}})", "camera.target: gives no direction"},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0, 0]}})", "camera.target: is missing"},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0], "target": [0, 0, 1]}})", "camera.eye: must be an array of 3"},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0, 1e39], "target": [0, 0, 1]}})", "camera.eye"},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0, 1e999], "target": [0, 0, 1]}})", "number overflow"},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0, NaN], "target": [0, 0, 1]}})", "JSON"},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0, 0], "target": [0, 1, 0]}})", "camera.up: is parallel"},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0, 0], "target": [0, 0, 1], "up": [0, 0, 0]}})", "camera.up"},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0, 0], "target": [0, 0, 1], "fov": 3}})", "unknown key \"fov\""},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0, 0], "target": [0, 0, 1], "verticalFovDegrees": 180}})", "verticalFovDegrees"},
        {R"({"scene": "cornell-box", "camera": {"eye": [0, 0, 0], "target": [0, 0, 1], "verticalFovDegrees": "45"}})", "must be a number"},
        {R"({"scene": "cornell-box", "lights": []})", "lights"},
        {R"({"scene": "cornell-box", "lights": {}})", "lights"},
        {light(""), "lights[0].type: is missing"},
        {light(R"("type": "area")"), "lights[0].type: must be directional, spot or point"},
        {light(R"("type": "directional")"), "lights[0].direction: is missing"},
        {light(R"("type": "directional", "direction": [0, 0, 0])"), "lights[0].direction: gives no direction"},
        {light(R"("type": "directional", "direction": [0, -1, 0], "intensity": -1)"), "lights[0].intensity"},
        {light(R"("type": "directional", "direction": [0, -1, 0], "color": [1, -1, 1])"), "lights[0].color"},
        {light(R"("type": "directional", "direction": [0, -1, 0], "range": 3)"), "unknown key \"range\""},
        {light(R"("type": "spot", "position": [0, 1, 0])"), "either target or direction"},
        {light(R"("type": "spot", "position": [0, 1, 0], "target": [0, 0, 0], "outerConeAngleDegrees": 90)"), "outerConeAngleDegrees"},
        {light(R"("type": "spot", "position": [0, 1, 0], "target": [0, 0, 0], "innerConeAngleDegrees": 46)"), "innerConeAngleDegrees"},
        {light(R"("type": "spot", "position": [0, 1, 0], "target": [0, 1, 0])"), "lights[0].target: gives no direction"},
    };
    const ScratchFolder folder;
    for (const Mistake& mistake : mistakes) {
        const std::string error = loadError(folder.write("view.json", mistake.text));
        CAPTURE(mistake.text, error);
        CHECK(error.find(mistake.mustSay) != std::string::npos);
        CHECK(error.find('\n') == std::string::npos);
        CHECK(error.find("view.json") != std::string::npos);
    }
    CHECK(loadError(folder.path("none.json")).find("no such file") != std::string::npos);
    folder.write("folder.json/inside", "");
    CHECK(loadError(folder.path("folder.json")).find("folder") != std::string::npos);
}

TEST_CASE("a camera is found by name before index, and a miss lists what there is", "[scene][camera]")
{
    Scene scene = loadScene("cornell-box", {});
    scene.cameras.resize(2);
    scene.cameras[0].name = "front";
    scene.cameras[1].name = "0";
    CHECK(&findCamera(scene, "front") == &scene.cameras[0]);
    CHECK(&findCamera(scene, "0") == &scene.cameras[1]);
    CHECK(&findCamera(scene, "1") == &scene.cameras[1]);
    for (const char* missing : {"2", "back", "", "-1", "99999999999999999999"}) {
        try {
            findCamera(scene, missing);
            FAIL("found " << missing);
        } catch (const InputError& error) {
            CHECK(std::string(error.what()).find("\"front\"") != std::string::npos);
        }
    }
}

TEST_CASE("the scene hash sees every field that can change a picture, and no name", "[scene][hash]")
{
    const Scene scene = loadScene("cornell-box", {});
    const std::string hash = hashScene(scene);
    CHECK(hash.size() == 64);
    const auto changed = [&](const auto& change) {
        Scene other = scene;
        change(other);
        return hashScene(other) != hash;
    };
    CHECK_FALSE(changed([](Scene& s) { s.name = "other", s.notes.push_back("x"), s.meshes[0].name = "y", s.lights[0].name = "z"; }));
    CHECK(changed([](Scene& s) { s.meshes[0].positions[0].x += 0.001f; }));
    CHECK(changed([](Scene& s) { s.meshes[0].normals[0].y += 0.001f; }));
    CHECK(changed([](Scene& s) { std::swap(s.meshes[0].triangles[0][0], s.meshes[0].triangles[0][1]); }));
    CHECK(changed([](Scene& s) { s.meshes[0].uv0.resize(s.meshes[0].positions.size()); }));
    CHECK(changed([](Scene& s) { s.meshes[0].uv1.resize(s.meshes[0].positions.size()); }));
    CHECK(changed([](Scene& s) { s.meshes[0].colors.resize(s.meshes[0].positions.size()); }));
    CHECK(changed([](Scene& s) { s.materials[0].baseColor.g *= 0.5f; }));
    CHECK(changed([](Scene& s) { s.materials[0].doubleSided ^= true; }));
    CHECK(changed([](Scene& s) { s.materials[0].roughness *= 0.5f; }));
    CHECK(changed([](Scene& s) { s.materials[0].normalTexture.uvOffset.x = 0.5f; }));
    CHECK(changed([](Scene& s) { s.lights[0].intensity.b *= 0.5f; }));
    CHECK(changed([](Scene& s) { s.lights[0].range = 3.0f; }));
    CHECK(changed([](Scene& s) { s.cameras[0].verticalFov *= 0.5f; }));
    CHECK(changed([](Scene& s) { s.textures.push_back(std::make_shared<Texture>()); }));
}

TEST_CASE("the default camera sees the whole box, flat or not", "[scene][defaults]")
{
    const Vec3 extents[] = {{1, 1, 1}, {10, 0.1f, 3}, {5, 0, 5}, {0, 5, 5}, {5, 5, 0}, {1e-3f, 1e-3f, 1e-3f}, {1e6f, 2e6f, 1e5f}, {0, 0, 4}};
    for (const Vec3& extent : extents) {
        CAPTURE(extent.x, extent.y, extent.z);
        Scene scene;
        const Vec3 lo(-3, 2, 7);
        scene.bounds.include(lo);
        scene.bounds.include(lo + extent);
        addDefaultCamera(scene);
        const Camera& camera = scene.cameras.at(0);
        CHECK(glm::length(camera.forward) == Approx(1));
        CHECK(std::abs(glm::dot(camera.forward, camera.up)) < 1e-6f);
        const double limit = std::tan(0.5 * double(camera.verticalFov));
        const Vec3 right = glm::cross(camera.forward, camera.up);
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 p = lo + extent * Vec3(corner & 1, (corner >> 1) & 1, corner >> 2) - camera.position;
            const float depth = glm::dot(p, camera.forward);
            CHECK(depth > camera.nearPlane);
            CHECK(std::abs(glm::dot(p, camera.up)) <= limit * double(depth));
            CHECK(std::abs(glm::dot(p, right)) <= limit * double(depth));
        }
    }
}
