#include "apps/common/messages.h"

#include "conetrace/render.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/light.h"
#include "core/scene/reach.h"
#include "core/scene/shapes.h"

#include "catch.h"

#include <algorithm>

using namespace lrsm;

namespace {

Settings smallSettings()
{
    Settings settings;
    settings.voxel.resolution = 64;
    settings.rsm.resolution = 64;
    return settings;
}

/// A floor and a crate, a spot and a camera above.
Scene room()
{
    Scene scene;
    scene.materials = {diffuseMaterial("white", Vec3(0.7f), true)};
    scene.meshes.resize(2);
    scene.meshes[0].name = "floor";
    addQuad(scene.meshes[0], Vec3(-2, 0, 2), Vec3(2, 0, 2), Vec3(2, 0, -2), Vec3(-2, 0, -2));
    scene.meshes[1].name = "crate";
    addBox(scene.meshes[1], Vec3(-0.25f, 0.1f, -0.25f), Vec3(0.25f, 0.6f, 0.25f));
    scene.lights.push_back(spotLight(Vec3(0.5f, 3, 1), Vec3(0), Vec3(10.0f), 0.5f, 0.7f));
    scene.cameras.push_back(lookAt(Vec3(0, 2, 4), Vec3(0), Vec3(0, 1, 0), 0.8f));
    updateBounds(scene);
    return scene;
}

std::vector<std::string> darkness(const Scene& scene)
{
    const Frame frame = renderFrame(scene, scene.cameras.at(0), smallSettings(), {.width = 32, .height = 18, .watch = {}, .method = {}});
    return darknessMessages(scene, {frame.gbuffer.position, frame.gbuffer.geometricNormal, frame.gbuffer.depthLinear}, frame.direct, frame.combined);
}

bool oneSays(const std::vector<std::string>& lines, const std::string& part)
{
    return lines.size() == 1 && lines[0].find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("messages: ordinary scenes at ordinary settings have none", "[apps][messages]")
{
    for (const BuiltinSceneInfo& info : builtinScenes()) {
        INFO(info.name);
        const Scene scene = *makeBuiltinScene(info.name);
        CHECK(loadMessages(scene).empty());
        CHECK(extentMessages(scene, scene.cameras.at(0), Settings{}).empty());
    }
    CHECK(darkness(room()).empty());
}

TEST_CASE("messages: a black picture says why", "[apps][messages]")
{
    SECTION("intensity 0")
    {
        Scene scene = room();
        scene.lights[0].intensity = Vec3(0.0f);
        CHECK(oneSays(darkness(scene), "black: every light has intensity 0"));
        CHECK(oneSays(loadMessages(scene), "1 light of 1 with intensity 0"));
    }
    SECTION("no light")
    {
        Scene scene = room();
        scene.lights.clear();
        CHECK(oneSays(darkness(scene), "the scene has no light"));
    }
    SECTION("nothing in view")
    {
        Scene scene = room();
        scene.cameras[0] = lookAt(Vec3(0, 2, 4), Vec3(0, 4, 8), Vec3(0, 1, 0), 0.8f);
        CHECK(oneSays(darkness(scene), "the camera sees no surface"));
    }
    SECTION("a spot that faces away")
    {
        Scene scene = room();
        scene.lights[0] = spotLight(Vec3(0.5f, 3, 1), Vec3(0.5f, 9, 1), Vec3(10.0f), 0.5f, 0.7f);
        CHECK(oneSays(darkness(scene), "faces away from the scene"));
    }
    SECTION("a sun below the floor of a scene seen from above")
    {
        Scene scene = room();
        scene.lights[0] = directionalLight(Vec3(0.05f, 1, 0), Vec3(10.0f));
        scene.meshes[1].triangles.clear();
        CHECK(oneSays(darkness(scene), "all of it faces away"));
    }
    SECTION("a light inside of a crate: its six faces are one line")
    {
        Scene scene = room();
        scene.lights = splitPointLight(Vec3(0.02f, 0.35f, 0.01f), Vec3(5.0f), kInfinity, "bulb");
        const std::vector<std::string> lines = darkness(scene);
        REQUIRE(lines.size() == 1);
        CHECK(lines[0].find("inside of something solid: mesh \"crate\"") != std::string::npos);
        CHECK(lines[0].find("(and 5 more)") != std::string::npos);
    }
    SECTION("something in between")
    {
        Scene scene = room();
        addQuad(scene.meshes[0], Vec3(-9, 2.5f, 9), Vec3(9, 2.5f, 9), Vec3(9, 2.5f, -9), Vec3(-9, 2.5f, -9));
        updateBounds(scene);
        CHECK(oneSays(darkness(scene), "something stands in between"));
    }
}

TEST_CASE("messages: notes that differ in a name alone are one line", "[apps][messages]")
{
    Scene scene = room();
    scene.notes = {"material \"a\": alpha blending replaced by a mask at 0.5", "extensions ignored: X",
                   "material \"b\": alpha blending replaced by a mask at 0.5", "material \"c\": alpha blending replaced by a mask at 0.5"};
    CHECK(loadMessages(scene) == std::vector<std::string>{"material \"a\": alpha blending replaced by a mask at 0.5 (and 2 more)", "extensions ignored: X"});
}

TEST_CASE("messages: saturation, and what an extent costs", "[apps][messages]")
{
    PassReport rsm;
    rsm.name = "rsm 0";
    rsm.counters = {{"half_saturations", 7.0}, {"nans", 0.0}};
    CHECK(oneSays(passMessages({rsm}), "7 values of light maps clamped to 65504"));
    rsm.counters[0].value = 0.0;
    CHECK(passMessages({rsm}).empty());

    Scene scene = room();
    scene.materials.push_back(diffuseMaterial("ground", Vec3(0.5f), true));
    scene.meshes.emplace_back().material = 1;
    addQuad(scene.meshes[2], Vec3(-9e3f, -0.01f, 9e3f), Vec3(9e3f, -0.01f, 9e3f), Vec3(9e3f, -0.01f, -9e3f), Vec3(-9e3f, -0.01f, -9e3f));
    scene.lights.push_back(directionalLight(Vec3(-1, -0.3f, 0), Vec3(2.0f)));
    updateBounds(scene);
    Settings settings;
    settings.voxel.extent = settings.rsm.extent = Extent::scene;
    const std::vector<std::string> whole = extentMessages(scene, scene.cameras[0], settings);
    REQUIRE(whole.size() == 1);
    CHECK(whole[0].find("a voxel is 35.4") == 0);
    scene.reach = measureReach(scene, scene.cameras[0]);
    CHECK(oneSays(extentMessages(scene, scene.cameras[0], Settings{}), "voxel grid and light maps cover"));
}

TEST_CASE("messages: depths of a light that are coarser than a bias", "[apps][messages]")
{
    // A plate 20 km up throws its shadow on a room of 4 m: depths over 20 km in texels of millimetres.
    Scene scene = room();
    scene.lights = {directionalLight(Vec3(0, -1, 0), Vec3(2.0f))};
    scene.reach = scene.bounds;
    scene.meshes.emplace_back().material = 0;
    const float y = GENERATE(20.0f, 20000.0f);
    addQuad(scene.meshes[2], Vec3(-1, y, 1), Vec3(1, y, 1), Vec3(1, y, -1), Vec3(-1, y, -1));
    updateBounds(scene);
    Settings settings;
    const auto saysSteps = [&](const std::string& what) {
        const std::vector<std::string> lines = extentMessages(scene, scene.cameras[0], settings);
        return std::any_of(lines.begin(), lines.end(),
                           [&](const std::string& line) { return line.find("come in steps of") != std::string::npos && line.find(what) != std::string::npos; });
    };
    CHECK(saysSteps("indirect light may be misplaced") == (y > 1000.0f));
    settings.direct.shadows = Shadows::hard;
    CHECK(saysSteps("shadows may be spotted") == (y > 1000.0f));
}

TEST_CASE("messages: faces of two materials in one plane", "[apps][messages]")
{
    Scene scene = room();
    scene.materials.push_back(diffuseMaterial("red", Vec3(0.7f, 0, 0), true));
    Mesh& rug = scene.meshes.emplace_back();
    rug.material = 1;
    rug.name = "rug";
    const float y = GENERATE(0.0f, 0.001f);
    const bool sameCorners = GENERATE(false, true);
    const float half = sameCorners ? 2.0f : 1.0f;
    addQuad(rug, Vec3(-half, y, half), Vec3(half, y, half), Vec3(half, y, -half), Vec3(-half, y, -half));
    const std::vector<std::string> lines = extentMessages(scene, scene.cameras[0], Settings{});
    if (y == 0.0f && !sameCorners)
        CHECK(oneSays(lines, "meshes \"floor\" and \"rug\" lie in one plane in view"));
    else
        CHECK(lines.empty());
}
