#include "core/base/errors.h"
#include "core/scene/load_scene.h"
#include "gltf_builder.h"

#include "catch.h"
#include "scenes.h"

using namespace lrsm;

namespace {

/// One triangle, (0,0,0) (1,0,0) (0,1,0), that its own animation lifts by 0 .. 2 m in 0 .. 2 s.
std::string liftedTriangle()
{
    GltfBuilder file;
    const int times = file.add<float>({0, 2}, "SCALAR", 5126), places = file.add<float>({0, 0, 0, 0, 2, 0}, "VEC3", 5126);
    file.json["animations"] = {
        {{"samplers", {{{"input", times}, {"output", places}}}}, {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    return file.glb();
}

std::string viewOf(const std::string& fields)
{
    return R"({"scene": "cornell-box", )" + fields + "}";
}

const char* const kAllMoves = R"(
    "camera": {"target": [0, 1, 0], "keys": [{"time": 0, "eye": [0, 1, 3]}, {"time": 4, "eye": [1, 1, 3], "verticalFovDegrees": 60}]},
    "lights": [{"type": "spot", "position": [0, 1.9, 0], "keys": [{"time": 0, "target": [0, 0, 0], "intensity": 1}, {"time": 3, "target": [0.5, 0, 0.5], "intensity": 7}]},
               {"type": "point", "color": [1, 0.5, 0.25], "keys": [{"time": 1, "position": [0, 1, 0]}, {"time": 2, "position": [0.25, 1, 0]}]}],
    "objects": [{"scene": "lift.glb", "keys": [{"time": 0, "position": [0, 0, 0]}, {"time": 1, "yaw": 0}, {"time": 2, "position": [1, 0, 0]}, {"time": 3, "yaw": 90}]},
                {"scene": "lift.glb", "material": {"baseColor": [0.5, 0.25, 0.125]}, "scale": 0.5, "animation": -1}])";

Vec3 lastCorner(const Scene& scene, std::size_t corner)
{
    return scene.meshes.back().positions[corner];
}

}  // namespace

TEST_CASE("numbers follow their keys, linear in time, and hold at the ends, and a key that leaves one out is none of its", "[scene][view]")
{
    const std::string text = viewOf(R"("lights": [{"type": "spot", "target": [0, 0, 0], "keys": [{"time": 1, "position": [0, 2, 0], "intensity": 1},
        {"time": 2, "intensity": 5}, {"time": 3, "position": [4, 2, 8]}]}])");
    struct Expected {
        double time;
        Vec3 position;
        float intensity;
    };
    for (const Expected& e : {Expected{-9, {0, 2, 0}, 1}, {1, {0, 2, 0}, 1}, {1.5, {1, 2, 2}, 3}, {2, {2, 2, 4}, 5}, {2.5, {3, 2, 6}, 5}, {99, {4, 2, 8}, 5}}) {
        const Light light = parseView(text, "view.json", {}, e.time).lights->at(0);
        CAPTURE(e.time);
        CHECK(light.position == e.position);
        CHECK(light.intensity == Vec3(e.intensity));
    }
    // At a key it is the key's own number, whatever stands beside it.
    const std::string odd =
        viewOf(R"("lights": [{"type": "directional", "direction": [0, -1, 0], "keys": [{"time": 0, "intensity": 1e9}, {"time": 0.1, "intensity": 0.3},
        {"time": 0.3, "intensity": 0.3}, {"time": 7, "intensity": 5e8}]}])");
    for (const double time : {0.1, 0.17, 0.2, 0.3}) CHECK(parseView(odd, "view.json", {}, time).lights->at(0).intensity.x == 0.3f);
}

TEST_CASE("an object is scaled, turned about +Y, moved, and has its own animation and material", "[scene][view]")
{
    const ScratchFolder folder;
    folder.write("lift.glb", liftedTriangle());
    const std::string view = folder.write("view.json", viewOf(R"("objects": [{"scene": "lift.glb", "material": {"baseColor": [0.5, 0.25, 0.125]},
        "scale": 2, "keys": [{"time": 0, "position": [1, 0, 0], "yaw": 0}, {"time": 1, "position": [3, 4, 5], "yaw": 90}]}])"));
    const Scene box = loadScene("cornell-box", {});
    const SceneSource source = openScene(view, {});
    const Scene scene = poseScene(source, 1.0f);
    REQUIRE(scene.meshes.size() == box.meshes.size() + 1);
    // +X turns to -Z; the animation's metre of lift is enlarged with the rest.
    const Vec3 expected[] = {{3, 6, 5}, {3, 6, 3}, {3, 8, 5}};
    for (std::size_t corner = 0; corner < 3; ++corner) CHECK(glm::length(lastCorner(scene, corner) - expected[corner]) < 1e-6f);
    CHECK(scene.bounds.contains(expected[2]));
    CHECK(scene.materials[std::size_t(scene.meshes.back().material)].baseColor == Vec4(0.5f, 0.25f, 0.125f, 1.0f));
    for (std::size_t m = 0; m < box.materials.size(); ++m) CHECK(scene.materials[m].baseColor == box.materials[m].baseColor);
    CHECK(scene.lights.size() == box.lights.size());
}

TEST_CASE("a scene posed from what was loaded once equals a freshly loaded one, at any time and in any order", "[scene][view]")
{
    const ScratchFolder folder;
    folder.write("lift.glb", liftedTriangle());
    const std::string view = folder.write("view.json", viewOf(kAllMoves));
    const SceneSource source = openScene(view, {});
    KeptPoses kept;
    std::vector<std::string> hashes;
    for (const float time : {2.5f, 0.0f, 1.25f, 2.5f, 2.5f, 100.0f}) {
        const Scene fresh = loadScene(view, {.time = time});
        hashes.push_back(hashScene(fresh));
        for (const Scene& posed : {poseScene(source, time), poseScene(source, time, &kept)}) {
            CHECK(hashScene(posed) == hashes.back());
            CHECK(posed.notes == fresh.notes);
            CHECK(posed.bounds == fresh.bounds);
        }
    }
    CHECK(hashes[0] == hashes[3]);
    CHECK(hashes[0] != hashes[1]);
    CHECK(hashes[1] != hashes[2]);
}

TEST_CASE("glTF files of several kinds of animation, posed and freshly loaded, are the same", "[scene][gltf]")
{
    LRSM_NEED_SCENES();
    for (const char* name : {"samples/InterpolationTest.glb", "samples/BoxAnimated.glb", "samples/AnimatedMorphCube.glb", "samples/Fox.glb"}) {
        const std::string path = (scenesFolder() / name).string();
        if (!std::filesystem::exists(path)) continue;
        const SceneSource source = openScene(path, {});
        const std::string first = hashScene(poseScene(source, 0.0f));
        CAPTURE(name);
        CHECK(hashScene(poseScene(source, 0.7f)) == hashScene(loadScene(path, {.time = 0.7f})));
        CHECK(hashScene(poseScene(source, 0.7f)) != first);
        KeptPoses kept;
        for (const float time : {0.0f, 0.7f, 0.7f, 0.0f}) CHECK((hashScene(poseScene(source, time, &kept)) == first) == (time == 0.0f));
    }
}

TEST_CASE("what does not move is the same to the bit at all times, whole turns included", "[scene][view]")
{
    const ScratchFolder folder;
    folder.write("lift.glb", liftedTriangle());
    const std::string view = folder.write("view.json", viewOf(R"("lights": [{"type": "directional", "keys": [{"time": 0, "direction": [0.1, -1, 0.3]},
        {"time": 3, "direction": [0.1, -1, 0.3]}]}], "objects": [{"scene": "lift.glb", "animation": -1, "keys": [{"time": 0, "yaw": 40}, {"time": 1, "yaw": 40},
        {"time": 3, "yaw": 400}]}])"));
    const SceneSource source = openScene(view, {});
    const std::string hash = hashScene(poseScene(source, 0.0f));
    for (const float time : {0.3f, 0.7f, 1.0f, 3.0f, 9.0f}) CHECK(hashScene(poseScene(source, time)) == hash);
    CHECK(hashScene(poseScene(source, 2.0f)) != hash);
}

TEST_CASE("every mistake in keys and objects is one line that names the place", "[scene][view]")
{
    const auto light = [](const std::string& fields) { return viewOf(R"("lights": [{"type": "directional", )" + fields + "}]"); };
    const auto object = [](const std::string& fields) { return viewOf(R"("objects": [{)" + fields + "}]"); };
    struct Mistake {
        std::string text, mustSay;
    };
    const Mistake mistakes[] = {
        {light(R"("keys": [])"), "view.json: lights[0].keys: is empty"},
        {light(R"("keys": 3)"), "lights[0].keys: must be a list"},
        {light(R"("keys": [3])"), "lights[0].keys[0]: must be an object"},
        {light(R"("keys": [{"direction": [0, -1, 0]}])"), "lights[0].keys[0].time: is missing"},
        {light(R"("keys": [{"time": "0", "direction": [0, -1, 0]}])"), "lights[0].keys[0].time: must be a number"},
        {light(R"("keys": [{"time": 1e9, "direction": [0, -1, 0]}])"), "lights[0].keys[0].time: 1000000000.0 is out of range"},
        {light(R"("keys": [{"time": 0}])"), "lights[0].keys[0]: has a time and nothing else; give direction, or "},
        {light(R"("keys": [{"time": 1, "direction": [0, -1, 0]}, {"time": 1, "direction": [0, -1, 1]}])"),
         "lights[0].keys[1].time: must be later than the key before, at 1.0 s"},
        {light(R"("keys": [{"time": 0, "direction": [0, -1]}])"), "lights[0].keys[0].direction: must be an array of 3 numbers"},
        {light(R"("keys": [{"time": 0, "direction": [0, -1, 0]}, {"time": 1, "direction": 2}])"), "lights[0].keys[1].direction: has another number of entries"},
        {light(R"("keys": [{"time": 0, "direction": [0, 0, 0]}])"), "lights[0] at 0.0 s: direction: gives no direction"},
        {light(R"("keys": [{"time": 0, "direction": [0, -1, 0]}, {"time": 4, "direction": [0, -1, 0], "colour": 3}])"),
         "lights[0].keys[1]: unknown key \"colour\"; known: time, direction"},
        {light(R"("keys": [{"time": 0, "direction": [0, -1, 0], "position": [0, 1, 0]}])"), "lights[0] at 0.0 s: unknown key \"position\""},
        {light(R"("direction": [0, -1, 0], "keys": [{"time": 0, "direction": [0, -1, 0]}])"), "lights[0].direction: is given by the keys too; leave out one"},
        {light(R"("direction": [0, -1, 0], "keys": [{"time": 0, "intensity": 1}, {"time": 5, "intensity": -1}])"), "lights[0] at 5.0 s: intensity: -1"},
        {viewOf(R"("camera": {"eye": [0, 0, 0], "keys": [{"time": 0, "target": [0, 0, 1]}, {"time": 1, "target": [0, 0, 0]}]})"),
         "camera at 1.0 s: target: gives no direction"},
        {viewOf(R"("keys": [])"), "unknown key \"keys\""},
        {viewOf(R"("objects": {})"), "objects: must be a list"},
        {object(""), "objects[0].scene: is missing"},
        {object(R"("scene": "")"), "objects[0].scene: is empty"},
        {object(R"("scene": "no-such.glb")"), "objects[0].scene: there is no file \""},
        {object(R"("scene": "cornell-box")"), "objects[0].scene: \"cornell-box\" must be a .gltf or .glb file"},
        {object(R"("scene": "lift.glb", "scale": 0)"), "objects[0].scale: 0 is out of range"},
        {object(R"("scene": "lift.glb", "animation": 1)"), "lift.glb: animations: there is no animation 1, only 1"},
        {object(R"("scene": "lift.glb", "animation": 0.5)"), "objects[0].animation: must be a whole number"},
        {object(R"("scene": "lift.glb", "position": [1, 2, null])"), "objects[0].position[2]: must be a number"},
        {object(R"("scene": "lift.glb", "roll": 2)"), "objects[0]: unknown key \"roll\"; known: scene, animation, material, position, yaw, scale"},
        {object(R"("scene": "lift.glb", "material": {"name": "a"})"), "objects[0].material: unknown key \"name\""},
        {object(R"("scene": "lift.glb", "material": {"roughness": 3})"), "objects[0].material.roughness: 3 is out of range"},
    };
    const ScratchFolder folder;
    folder.write("lift.glb", liftedTriangle());
    for (const Mistake& mistake : mistakes) {
        std::string said = "(no error)";
        try {
            loadScene(folder.write("view.json", mistake.text), {});
        } catch (const InputError& error) {
            said = error.what();
        }
        CAPTURE(mistake.text, said);
        CHECK(said.find(mistake.mustSay) != std::string::npos);
        CHECK(said.find('\n') == std::string::npos);
    }
    // Between two sound keys: found when that moment is asked for.
    const SceneSource source =
        openScene(folder.write("view.json", light(R"("keys": [{"time": 0, "direction": [0, -1, 0]}, {"time": 2, "direction": [0, 1, 0]}])")), {});
    CHECK_NOTHROW(checkMoment(source, 0.5f));
    CHECK_THROWS_AS(checkMoment(source, 1.0f), InputError);
}
