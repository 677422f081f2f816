// What common writers get wrong: mended, with a note, to the scene that the right file gives.
#include "core/scene/gltf.h"
#include "core/scene/scene_hash.h"

#include "catch.h"
#include "gltf_builder.h"
#include "scenes.h"

#include <functional>

using namespace lrsm;

namespace {

using Json = nlohmann::json;

bool says(const Scene& scene, const std::string& part)
{
    return std::any_of(scene.notes.begin(), scene.notes.end(), [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

/// A triangle with a texture sampler, a spot light and a moving node: what the repairs are about.
GltfBuilder furnished()
{
    GltfBuilder b;
    b.json["samplers"] = {{{"wrapS", 10497}, {"wrapT", 10497}}};
    b.json["materials"] = {{{"name", "m"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0.5, 1}}, {"metallicFactor", 0}}}}};
    b.primitive()["material"] = 0;
    b.json["extensionsUsed"] = {"KHR_lights_punctual"};
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}};
    b.json["nodes"].push_back({{"translation", {0, 0, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    b.json["scenes"][0]["nodes"] = {0, 1};
    return b;
}

Json& light(GltfBuilder& b)
{
    return b.json["extensions"]["KHR_lights_punctual"]["lights"][0];
}

}  // namespace

TEST_CASE("repairs give the scene of the right file and a note", "[scene][gltf][repair]")
{
    struct Repair {
        std::string note;  ///< "": nothing to say
        std::function<void(GltfBuilder&)> slip;
        std::function<void(GltfBuilder&)> right = [](GltfBuilder&) {};
    };
    const std::vector<Repair> repairs = {
        {"2 null values", [](GltfBuilder& b) { b.node()["skin"] = nullptr, b.json["materials"][0]["normalTexture"] = nullptr; }},
        {"1 null value",
         [](GltfBuilder& b) {
             b.json["scenes"][0]["nodes"] = {0, nullptr, 1};
         }},
        {"1 null value", [](GltfBuilder& b) { b.json["cameras"] = nullptr; }},
        {"1 null value", [](GltfBuilder& b) { light(b)["range"] = nullptr; }},
        {"",
         [](GltfBuilder& b) {
             b.json["accessors"][0]["min"] = {nullptr, nullptr, nullptr};
         }},
        {"", [](GltfBuilder& b) { b.node()["mesh"] = 0.0, b.json["accessors"][0]["count"] = 3.0, b.json["scene"] = 0.0; }},
        {"1 byteStride of 0", [](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 0; }},
        {"1 byteStride of 0", [](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 0.0; }},
        {"", [](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 12; }},
        {"2 unknown wrap modes",
         [](GltfBuilder& b) {
             b.json["samplers"][0] = {{"wrapS", 10496}, {"wrapT", "REPEAT"}, {"magFilter", "LINEAR"}};
         }},
        {"1 unknown wrap mode", [](GltfBuilder& b) { b.json["samplers"][0]["wrapT"] = 33069; }},
        {"1 light with a range of 0", [](GltfBuilder& b) { light(b)["range"] = 0; }},
        {"1 light colour of four numbers",
         [](GltfBuilder& b) {
             light(b)["color"] = {1, 1, 1, 1};
         }},
        {"without cone angles", [](GltfBuilder& b) { light(b).erase("spot"); },
         [](GltfBuilder& b) {
             light(b)["spot"] = {{"innerConeAngle", 0}, {"outerConeAngle", 0.78539816}};
         }},
        {"hard edge", [](GltfBuilder& b) { light(b)["spot"]["innerConeAngle"] = 0.5; }},
        {"hard edge", [](GltfBuilder& b) { light(b)["spot"]["innerConeAngle"] = 0.50000003; },
         [](GltfBuilder& b) { light(b)["spot"]["innerConeAngle"] = 0.5; }},
        {"hard edge",
         [](GltfBuilder& b) {
             light(b)["spot"] = {{"innerConeAngle", 1.5707964}, {"outerConeAngle", 1.5707964}};
         },
         [](GltfBuilder& b) {
             light(b)["spot"] = {{"innerConeAngle", 1.5707963}, {"outerConeAngle", 1.5707963}};
         }},
        {"unknown alphaMode \"mask\" taken as OPAQUE", [](GltfBuilder& b) { b.json["materials"][0]["alphaMode"] = "mask"; }},
        {"2 material factors",
         [](GltfBuilder& b) {
             b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1.0000002, 0.5, 0.5, 1};
             b.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = -1e-9;
         }},
    };
    for (const Repair& repair : repairs) {
        GltfBuilder slipped = furnished(), right = furnished();
        repair.slip(slipped);
        repair.right(right);
        CAPTURE(repair.note, slipped.json.dump());
        Scene scene;
        REQUIRE_NOTHROW(scene = slipped.load());
        if (repair.note == "hard edge" && scene.lights[0].innerConeAngle == scene.lights[0].outerConeAngle) {
            CHECK(says(scene, repair.note));
            continue;
        }
        CHECK(hashScene(scene) == hashScene(right.load()));
        CHECK((repair.note.empty() || says(scene, repair.note)));
    }
}

TEST_CASE("an inner cone far beyond the outer, and a null among numbers, stay errors", "[scene][gltf][repair]")
{
    GltfBuilder b = furnished();
    light(b)["spot"]["innerConeAngle"] = 0.6;
    CHECK(b.error().find("innerConeAngle must be smaller") != std::string::npos);
    b = furnished();
    b.node()["translation"] = {0, nullptr, 0};
    CHECK(b.error().find("nodes[0].translation[1]") != std::string::npos);
}

TEST_CASE("keyframes out of order are sorted, and those of one time are a jump", "[scene][gltf][repair]")
{
    const auto at = [](const std::vector<float>& times, const std::vector<float>& values, const char* interpolation, float time) {
        GltfBuilder b;
        const int input = b.add<float>(times, "SCALAR", 5126), output = b.add<float>(values, "VEC3", 5126);
        b.json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
                                 {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}}};
        const Scene scene = b.load({.time = time});
        return std::pair(scene.meshes[0].positions[0].x, says(scene, "out of order"));
    };
    CHECK(at({0, 2, 1}, {0, 0, 0, 4, 0, 0, 1, 0, 0}, "LINEAR", 1.0f) == std::pair(1.0f, true));
    CHECK(at({0, 2, 1}, {0, 0, 0, 4, 0, 0, 1, 0, 0}, "LINEAR", 1.5f) == std::pair(2.5f, true));
    CHECK(at({0, 2, 1}, {0, 0, 0, 4, 0, 0, 1, 0, 0}, "STEP", 1.5f) == std::pair(1.0f, true));
    CHECK(at({1, 0}, {9, 0, 0, 5, 0, 0, 9, 0, 0, 9, 0, 0, 3, 0, 0, 9, 0, 0}, "CUBICSPLINE", 0.0f) == std::pair(3.0f, true));
    const std::vector<float> jump = {0, 0, 0, 1, 0, 0, 5, 0, 0, 6, 0, 0};
    CHECK(at({0, 1, 1, 2}, jump, "LINEAR", 0.5f) == std::pair(0.5f, false));
    CHECK(at({0, 1, 1, 2}, jump, "LINEAR", 1.0f) == std::pair(5.0f, false));
    CHECK(at({0, 1, 1, 2}, jump, "LINEAR", 1.5f) == std::pair(5.5f, false));
    CHECK(at({0, 1, 1}, {0, 0, 0, 1, 0, 0, 5, 0, 0}, "LINEAR", 3.0f) == std::pair(5.0f, false));
    CHECK(at({1, 1}, {1, 0, 0, 5, 0, 0}, "LINEAR", 0.0f) == std::pair(1.0f, false));
}

TEST_CASE("data URIs are read in every dress of base64", "[scene][gltf][repair]")
{
    // One triangle, 36 bytes, with a letter of either alphabet: 0xfb 0xff is "-_8" or "+/8".
    const auto scene = [](const std::string& uri) {
        Json json = GltfBuilder().json;
        json["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
        const ScratchFolder folder;
        return loadGltf(folder.write("a.gltf", json.dump()), {});
    };
    const std::string head = "data:application/octet-stream;base64,", body = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8+/8A/";
    const std::string hash = hashScene(scene(head + body));
    const auto dressed = [&](const std::string& uri) {
        const Scene other = scene(uri);
        return hashScene(other) == hash && says(other, "odd base64");
    };
    CHECK(dressed(head + "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8-_8A_"));
    CHECK(dressed(head + body.substr(0, 20) + "\r\n" + body.substr(20) + "\n"));
    CHECK(dressed(head + "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8%2B%2f8A%2F"));
    CHECK(dressed("data:application/octet-stream; base64 ," + body));
    CHECK(dressed("DATA:application/gltf-buffer;BASE64," + body));
    for (const std::string& plain : {head + body + "==", "data:;base64," + body, "data:text/plain;charset=utf-8;base64," + body}) {
        CHECK(hashScene(scene(plain)) == hash);
        CHECK_FALSE(says(scene(plain), "odd base64"));
    }
    CHECK_THROWS_AS(scene(head + "AAAA!AAA" + body), InputError);
    CHECK_THROWS_AS(scene("data:application/octet-stream," + body), InputError);
}

TEST_CASE("file names of other systems are found beside the file", "[scene][gltf][repair]")
{
    const ScratchFolder folder;
    folder.write("sub/a b.bin", std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0", 36));
    folder.write("50%25.bin", std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0", 36));
    folder.write("back\\slash.bin", std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0", 36));
    folder.write("c.bin", std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0", 36));
    const auto noteOf = [&](const std::string& uri) {
        Json json = GltfBuilder().json;
        json["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
        const Scene scene = loadGltf(folder.write("a.gltf", json.dump()), {});
        return says(scene, "read as");
    };
    CHECK(noteOf("sub\\a b.bin"));
    CHECK(noteOf("sub\\a%20b.bin"));
    CHECK(noteOf("sub%5Ca%20b.bin"));
    CHECK(noteOf(".\\sub\\a b.bin"));
    CHECK(noteOf("50%25.bin"));
    CHECK(noteOf("C:\\Users\\me\\c.bin"));
    CHECK(noteOf("file:///home/me/c.bin"));
    CHECK(noteOf("c.bin?v=3"));
    CHECK_FALSE(noteOf("sub/a%20b.bin"));
    CHECK_FALSE(noteOf("back\\slash.bin"));
    CHECK_THROWS_AS(noteOf("sub\\none.bin"), InputError);
}

TEST_CASE("a light below a node of scale 0 shines the way the rotations turn it", "[scene][gltf][repair]")
{
    for (const char* type : {"spot", "directional", "point"}) {
        for (const Json& scale : {Json{0, 0, 0}, Json{1, 1, 0}, Json{0, 1, 1}, Json{1, 0, 1}}) {
            GltfBuilder b = furnished();
            light(b)["type"] = type;
            b.json["nodes"].push_back({{"scale", scale}, {"rotation", {0.6, 0, 0, 0.8}}, {"translation", {0, 1, 0}}, {"children", {1}}});
            b.json["nodes"][1].erase("translation");
            b.json["scenes"][0]["nodes"] = {0, 2};
            const Scene zero = b.load();
            b.json["nodes"][2]["scale"] = {1, 1, 1};
            const Scene one = b.load();
            CAPTURE(type, scale.dump());
            CHECK(glm::length(zero.lights[0].direction - one.lights[0].direction) < 1e-6f);
            CHECK(zero.lights[0].position == one.lights[0].position);
            const bool lost = std::string(type) != "point" && (scale[2] == 0 || scale[1] == 0);
            CHECK(says(zero, "a scale of 0") == lost);
        }
    }
}

TEST_CASE("textures read whichever two sets of coordinates their material names", "[scene][gltf][repair]")
{
    GltfBuilder b;
    for (int set = 0; set < 4; ++set) {
        const float u = float(set);
        b.attributes()["TEXCOORD_" + std::to_string(set)] = b.add<float>({u, 0, u + 0.5f, 0, u, 0.5f}, "VEC2", 5126);
    }
    b.json["images"] = {{{"uri", "none.png"}}};
    b.json["textures"] = Json::array({Json::object()});  // without a source: ignored, but its coordinates are numbered before
    b.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 3}}}, {"metallicRoughnessTexture", {{"index", 0}, {"texCoord", 2}}}}}}};
    b.primitive()["material"] = 0;
    Scene scene = b.load();
    CHECK(scene.meshes[0].uv0[0] == Vec2(3, 0));
    CHECK(scene.meshes[0].uv1[0] == Vec2(2, 0));
    b.json["materials"][0]["normalTexture"] = {{"index", 0}, {"texCoord", 3}};
    CHECK(b.load().meshes[0].uv0[0] == Vec2(3, 0));
    b.json["materials"][0]["normalTexture"]["texCoord"] = 0;
    CHECK(says(b.load(), "the third set"));
}

TEST_CASE("instances are the node's mesh moved, turned and scaled", "[scene][gltf][repair]")
{
    GltfBuilder b;
    b.attributes()["NORMAL"] = b.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
    const int translation = b.add<float>({1, 0, 0, -1, 0, -1}, "VEC3", 5126), rotation = b.add<std::int8_t>({0, 0, 127, 0, 0, 0, 0, 127}, "VEC4", 5120, true),
              scale = b.add<float>({1, 1, 1, 2, 2, -2}, "VEC3", 5126), three = b.add<float>({1, 1, 1, 1, 1, 1, 1, 1, 1}, "VEC3", 5126);
    b.node()["translation"] = {0, 10, 0};
    Json& attributes = b.node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes = {{"TRANSLATION", translation}};
    Scene scene = b.load();
    REQUIRE(scene.meshes.size() == 2);
    CHECK(scene.meshes[0].positions[1] == Vec3(2, 10, 0));
    CHECK(scene.meshes[1].positions[1] == Vec3(0, 10, -1));
    attributes = {{"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}, {"_ID", three}};
    b.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    scene = b.load();
    CHECK(glm::length(scene.meshes[0].positions[1] - Vec3(0, 10, 0)) < 1e-6f);  // half a turn about z
    CHECK(scene.meshes[1].positions[1] == Vec3(1, 10, -1));
    CHECK(scene.meshes[1].normals[0].z == -1.0f);
    CHECK(scene.meshes[1].triangles[0] == std::array<std::uint32_t, 3>{0, 2, 1});  // mirrored: winding and normal still agree
    attributes["SCALE"] = three;
    CHECK(b.error().find("differ in length") != std::string::npos);
    attributes = {{"_ID", three}};
    CHECK(b.error().find("none of TRANSLATION") != std::string::npos);
}

TEST_CASE("materials of extensions: diffuse of specular-glossiness, unlit, emissive are said", "[scene][gltf][repair]")
{
    GltfBuilder b;
    b.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_materials_pbrSpecularGlossiness", "KHR_materials_transmission"};
    b.json["extensionsUsed"] = b.json["extensionsRequired"];
    b.json["materials"] = Json::parse(R"([{"name": "a", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]},
        "extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.25, 0.5, 0.75, 1], "specularFactor": [1, 1, 1], "glossinessFactor": 1}}},
        {"name": "b", "extensions": {"KHR_materials_unlit": {}}, "emissiveFactor": [0, 2, 0]}, {"extensions": {"KHR_materials_pbrSpecularGlossiness": {}}}])");
    const Scene scene = b.load();
    CHECK(scene.materials[0].baseColor == Vec4(0.25f, 0.5f, 0.75f, 1.0f));
    CHECK(scene.materials[0].metallic == 0.0f);
    CHECK(scene.materials[0].roughness == 1.0f);
    CHECK(scene.materials[2].baseColor == Vec4(1.0f));
    CHECK(says(scene, "unlit material \"b\""));
    CHECK(says(scene, "emissive material \"b\""));
    CHECK(says(scene, "extensions ignored: KHR_materials_transmission"));
    b.json["extensionsRequired"] = {"KHR_texture_basisu"};
    CHECK(b.error().find("gltf-transform ktxdecompress") != std::string::npos);
}

TEST_CASE("files of bug reports load as their twins, which have no fault", "[scene][gltf][repair]")
{
    LRSM_NEED_SCENES();
    const std::filesystem::path bugs = scenesFolder() / "bugs";
    if (!std::filesystem::exists(bugs)) {
        WARN("SKIPPED: no " << bugs);
        return;
    }
    for (const char* name : {"a10-texcoord2", "b15f-uri-backslash", "c02-unlit-required", "c03-emissive", "c07-instancing", "y01-bytestride0"}) {
        CAPTURE(name);
        const Scene scene = loadGltf((bugs / name / "scene.gltf").string(), {}), twin = loadGltf((bugs / name / "twin.gltf").string(), {});
        CHECK(hashScene(scene) == hashScene(twin));
    }
    const auto first = [](const Scene& scene) { return scene.meshes.back().positions.front(); };
    CHECK(first(loadGltf((bugs / "d02-unsorted" / "scene.gltf").string(), {})) == first(loadGltf((bugs / "d02-unsorted" / "twin.gltf").string(), {})));
    CHECK(loadGltf((bugs / "c08c-spot-inner-eq-outer" / "scene.gltf").string(), {}).lights[0].innerConeAngle == 0.6f);
}
