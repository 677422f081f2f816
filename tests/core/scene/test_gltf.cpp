// glTF's rules one by one, on files made here.
#include "core/scene/gltf.h"

#include "catch.h"
#include "gltf_builder.h"

using namespace lrsm;

namespace {

bool hasNote(const Scene& scene, const std::string& part)
{
    for (const std::string& note : scene.notes)
        if (note.find(part) != std::string::npos) return true;
    return false;
}

/// The normal that the winding gives: counter-clockwise seen from its tip.
Vec3 windingNormal(const Mesh& mesh, std::size_t t = 0)
{
    const auto& i = mesh.triangles[t];
    return glm::normalize(glm::cross(mesh.positions[i[1]] - mesh.positions[i[0]], mesh.positions[i[2]] - mesh.positions[i[0]]));
}

// A 2 x 1 PNG: red, green.
const std::vector<unsigned char> kRedGreen = {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
                                              0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00, 0x00, 0x7b, 0x40, 0xe8, 0xdd, 0x00, 0x00, 0x00,
                                              0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8, 0xcf, 0xc0, 0xc0, 0xf0, 0x9f, 0x01, 0x00, 0x07, 0xff,
                                              0x01, 0xff, 0xb8, 0x04, 0x35, 0xe0, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

}  // namespace

TEST_CASE("a primitive without normals gets flat ones and glTF's default material", "[scene][gltf]")
{
    const Scene scene = GltfBuilder().load();
    REQUIRE(scene.triangleCount() == 1);
    for (const Vec3& n : scene.meshes[0].normals) CHECK(n == Vec3(0, 0, 1));
    const Material& material = scene.materials[std::size_t(scene.meshes[0].material)];
    CHECK(material.baseColor == Vec4(1));
    CHECK(material.metallic == 1.0f);
    CHECK(material.roughness == 1.0f);
    CHECK_FALSE(material.doubleSided);
    CHECK(hasNote(scene, "no lights"));
    CHECK(hasNote(scene, "no camera"));
    CHECK(scene.bounds.max == Vec3(1, 1, 0));
}

TEST_CASE("flat normals split shared vertices and carry the other streams along", "[scene][gltf]")
{
    GltfBuilder b;
    b.attributes()["POSITION"] = b.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", 5126);
    b.attributes()["TEXCOORD_0"] = b.add<float>({0, 1, 2, 3, 4, 5, 6, 7}, "VEC2", 5126);
    b.primitive()["indices"] = b.add<std::uint8_t>({0, 1, 2, 0, 3, 1}, "SCALAR", 5121);
    const Mesh mesh = b.load().meshes.at(0);
    REQUIRE(mesh.positions.size() == 6);
    CHECK(mesh.normals[0] == Vec3(0, 0, 1));
    CHECK(mesh.normals[3] == Vec3(0, 1, 0));
    CHECK(mesh.uv0[4] == Vec2(6, 7));
}

TEST_CASE("a node of negative determinant turns triangles over, so that normals and winding agree", "[scene][gltf]")
{
    GltfBuilder b;
    b.attributes()["NORMAL"] = b.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
    b.attributes()["TANGENT"] = b.add<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 5126);
    SECTION("mirrored in x")
    {
        b.node()["scale"] = {-1, 1, 1};
        const Mesh mesh = b.load().meshes.at(0);
        CHECK(mesh.normals[0] == Vec3(0, 0, 1));
        CHECK(windingNormal(mesh) == Vec3(0, 0, 1));
        CHECK(mesh.tangents[0] == Vec4(-1, 0, 0, -1));  // bitangent = -cross(n, t) = +y, as before the mirror
    }
    SECTION("mirrored in z")
    {
        b.node()["scale"] = {1, 1, -1};
        const Mesh mesh = b.load().meshes.at(0);
        CHECK(mesh.normals[0] == Vec3(0, 0, -1));
        CHECK(windingNormal(mesh) == Vec3(0, 0, -1));
    }
    SECTION("not mirrored")
    {
        b.node()["scale"] = {-1, -1, 1};
        CHECK(windingNormal(b.load().meshes.at(0)) == Vec3(0, 0, 1));
    }
    SECTION("without normals the flat ones follow the turned triangle")
    {
        b.attributes().erase("NORMAL");
        b.node()["scale"] = {-1, 1, 1};
        CHECK(b.load().meshes.at(0).normals[0] == Vec3(0, 0, 1));
    }
}

TEST_CASE("normals go with the inverse transpose, also through a flattening scale", "[scene][gltf]")
{
    GltfBuilder b;
    const float s = std::sqrt(0.5f);
    b.attributes()["POSITION"] = b.add<float>({0, 0, 0, 0, 0, 1, 1, -1, 0}, "VEC3", 5126);  // in the plane x + y = 0
    b.attributes()["NORMAL"] = b.add<float>({s, s, 0, s, s, 0, s, s, 0}, "VEC3", 5126);
    b.node()["scale"] = {2, 1, 3};
    const Mesh mesh = b.load().meshes.at(0);
    CHECK(std::abs(glm::dot(mesh.normals[0], mesh.positions[2] - mesh.positions[0])) < 1e-6f);
    CHECK(mesh.normals[0].x == Approx(1 / std::sqrt(5.0)));

    b.attributes()["POSITION"] = b.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 5126);
    b.attributes()["NORMAL"] = b.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
    b.node()["scale"] = {1, 1, 0};
    CHECK(b.load().meshes.at(0).normals[0] == Vec3(0, 0, 1));
}

TEST_CASE("transforms nest: translation, rotation, scale, then the parent", "[scene][gltf]")
{
    GltfBuilder b;
    const double s = std::sqrt(0.5);
    b.json["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}}, {{"mesh", 0}, {"rotation", {0, 0, s, s}}, {"scale", {2, 1, 1}}}};
    const Mesh mesh = b.load().meshes.at(0);
    CHECK(glm::distance(mesh.positions[1], Vec3(10, 2, 0)) < 1e-6f);  // x scaled by 2, turned to y, moved
    CHECK(glm::distance(mesh.positions[2], Vec3(9, 0, 0)) < 1e-6f);

    b.json["nodes"][1] = {{"mesh", 0}, {"matrix", {0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
    CHECK(glm::distance(b.load().meshes.at(0).positions[1], Vec3(10, 2, 0)) < 1e-6f);
}

TEST_CASE("strips and fans keep the winding of their first triangle", "[scene][gltf]")
{
    GltfBuilder b;
    SECTION("strip")
    {
        b.attributes()["POSITION"] = b.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3", 5126);
        b.primitive()["mode"] = 5;
    }
    SECTION("fan")
    {
        b.attributes()["POSITION"] = b.add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0}, "VEC3", 5126);
        b.primitive()["mode"] = 6;
    }
    const Mesh mesh = b.load().meshes.at(0);
    REQUIRE(mesh.triangles.size() == 3);
    float area = 0.0f;
    for (std::size_t t = 0; t < 3; ++t) {
        CHECK(windingNormal(mesh, t) == Vec3(0, 0, 1));
        const auto& i = mesh.triangles[t];
        area += 0.5f * glm::length(glm::cross(mesh.positions[i[1]] - mesh.positions[i[0]], mesh.positions[i[2]] - mesh.positions[i[0]]));
    }
    CHECK(area == Approx(1.5));
}

TEST_CASE("points and lines are skipped and counted", "[scene][gltf]")
{
    GltfBuilder b;
    b.json["meshes"][0]["primitives"].push_back({{"attributes", b.attributes()}, {"mode", 0}});
    b.json["meshes"][0]["primitives"].push_back({{"attributes", b.attributes()}, {"mode", 3}});
    const Scene scene = b.load();
    CHECK(scene.triangleCount() == 1);
    CHECK(hasNote(scene, "2 primitives of points or lines skipped"));
}

TEST_CASE("normalised integers reach exactly 0, 1 and -1, colours of three have alpha 1", "[scene][gltf]")
{
    GltfBuilder b;
    b.attributes()["TEXCOORD_0"] = b.add<std::uint16_t>({0, 65535, 32768, 0, 65535, 1}, "VEC2", 5123, true);
    b.attributes()["COLOR_0"] = b.add<std::uint8_t>({0, 255, 51, 255, 0, 0, 1, 2, 3}, "VEC3", 5121, true);
    b.json["bufferViews"].back()["byteLength"] = 9;
    const Mesh mesh = b.load().meshes.at(0);
    CHECK(mesh.uv0[0] == Vec2(0, 1));
    CHECK(mesh.uv0[1].x == 32768.0f / 65535.0f);
    CHECK(mesh.colors[0] == Vec4(0, 1, 51.0f / 255.0f, 1));
}

TEST_CASE("signed quantised positions need the extension", "[scene][gltf]")
{
    GltfBuilder b;
    b.attributes()["POSITION"] = b.add<std::int16_t>({-32768, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0}, "VEC3", 5122, true);
    b.json["accessors"].back()["count"] = 3;
    b.json["bufferViews"].back()["byteStride"] = 8;
    b.json["accessors"].back()["count"] = 3;
    CHECK(b.error().find("attributes.POSITION") != std::string::npos);
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const Mesh mesh = b.load().meshes.at(0);
    CHECK(mesh.positions[0] == Vec3(-1, 0, 0));  // -32768 clamps
    CHECK(mesh.positions[1] == Vec3(1, 0, 0));
    CHECK(mesh.positions[2] == Vec3(0, -1, 0));
}

TEST_CASE("sparse values replace the base, or zeros where there is none", "[scene][gltf]")
{
    GltfBuilder b;
    const int indices = b.addView(std::vector<std::uint16_t>{1, 2}), values = b.addView(std::vector<float>{5, 0, 0, 0, 7, 0});
    b.json["accessors"][0]["sparse"] = {{"count", 2}, {"indices", {{"bufferView", indices}, {"componentType", 5123}}}, {"values", {{"bufferView", values}}}};
    const auto check = [&] {
        const Mesh mesh = b.load().meshes.at(0);
        CHECK(mesh.positions[0] == Vec3(0));
        CHECK(mesh.positions[1] == Vec3(5, 0, 0));
        CHECK(mesh.positions[2] == Vec3(0, 7, 0));
    };
    check();
    b.json["accessors"][0].erase("bufferView");
    check();
    b.json["accessors"][0]["sparse"]["indices"]["componentType"] = 5121;  // reads 1, 0: moves vertex 0
    CHECK(b.load().meshes.at(0).positions[0] == Vec3(0, 7, 0));
}

TEST_CASE("extensions: required and unknown is an error that names it, used and unknown is a note", "[scene][gltf]")
{
    GltfBuilder b;
    b.json["extensionsUsed"] = {"KHR_texture_basisu", "KHR_materials_clearcoat"};
    CHECK(hasNote(b.load(), "KHR_texture_basisu, KHR_materials_clearcoat"));
    b.json["extensionsRequired"] = {"KHR_materials_clearcoat", "KHR_texture_basisu"};
    CHECK(b.error().find("extensionsRequired: not supported: KHR_texture_basisu; decompress") != std::string::npos);
}

TEST_CASE("lights: axis, cone, range and the split of points", "[scene][gltf][light]")
{
    GltfBuilder b;
    const double s = std::sqrt(0.5);
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = nlohmann::json::parse(R"([
        {"type": "directional", "color": [1, 0.5, 0.25], "intensity": 4},
        {"type": "spot", "range": 20, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 1.57}},
        {"type": "point", "name": "lamp", "intensity": 3}])");
    const auto lightNode = [](int light) { return nlohmann::json{{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}}; };
    b.json["nodes"] = {{{"mesh", 0}, {"children", {1, 2, 3}}}, lightNode(0), lightNode(1), lightNode(2)};
    b.json["nodes"][1]["rotation"] = {-s, 0, 0, s};  // -z turns to -y
    b.json["nodes"][2]["translation"] = {1, 2, 3};
    b.json["nodes"][3]["scale"] = {5, 5, 5};
    const Scene scene = b.load();
    REQUIRE(scene.lights.size() == 8);
    CHECK(scene.lights[0].type == LightType::directional);
    CHECK(glm::distance(scene.lights[0].direction, Vec3(0, -1, 0)) < 1e-6f);
    CHECK(scene.lights[0].intensity == Vec3(4, 2, 1));
    CHECK(scene.lights[1].position == Vec3(1, 2, 3));
    CHECK(scene.lights[1].direction == Vec3(0, 0, -1));
    CHECK(scene.lights[1].range == 20.0f);
    CHECK(scene.lights[1].outerConeAngle < 1.5708f * 89.01f / 90.0f);
    CHECK(hasNote(scene, "outer cone angle reduced"));
    CHECK(hasNote(scene, "\"lamp\" split into six"));
    for (std::size_t i = 2; i < 8; ++i) CHECK(scene.lights[i].type == LightType::cubeFace);
    CHECK(scene.lights[7].intensity == Vec3(3));

    b.json["extensions"]["KHR_lights_punctual"]["lights"][1]["spot"] = {{"innerConeAngle", 1.57}, {"outerConeAngle", 1.5}};
    CHECK(b.error().find("innerConeAngle") != std::string::npos);
}

TEST_CASE("cameras take place and axes from their node", "[scene][gltf][camera]")
{
    GltfBuilder b;
    b.json["cameras"] = nlohmann::json::parse(R"([{"type": "perspective", "name": "wide", "perspective": {"yfov": 1.2, "znear": 0.5, "aspectRatio": 2}},
        {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 9}}])");
    b.json["nodes"] = {
        {{"mesh", 0}, {"children", {1, 2}}}, {{"camera", 0}, {"rotation", {0, 1, 0, 0}}, {"translation", {0, 0, -4}}}, {{"camera", 1}, {"name", "flat"}}};
    const Scene scene = b.load();
    REQUIRE(scene.cameras.size() == 2);
    CHECK(scene.cameras[0].name == "wide");
    CHECK(scene.cameras[0].forward == Vec3(0, 0, 1));
    CHECK(scene.cameras[0].position == Vec3(0, 0, -4));
    CHECK(scene.cameras[0].verticalFov == 1.2f);
    CHECK(scene.cameras[0].aspect == 2.0f);
    CHECK(scene.cameras[0].nearPlane == 0.5f);
    CHECK(scene.cameras[1].name == "flat");
    CHECK_FALSE(scene.cameras[1].perspective);
    CHECK(scene.cameras[1].verticalExtent == 4.0f);
    CHECK(scene.cameras[1].aspect == 1.5f);
}

TEST_CASE("materials: blending becomes a mask, the transform of the extension's own example reads its quadrant", "[scene][gltf]")
{
    GltfBuilder b;
    b.addPng(kRedGreen);
    b.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    b.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    b.json["materials"] = nlohmann::json::parse(R"([{"alphaMode": "BLEND", "alphaCutoff": 0.9, "occlusionTexture": {"index": 0}, "emissiveFactor": [1, 0, 0],
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform":
        {"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5], "texCoord": 1}}}}}])");
    b.primitive()["material"] = 0;
    const Scene scene = b.load();
    const Material& material = scene.materials[0];
    CHECK(material.alphaMask);
    CHECK(material.alphaCutoff == 0.5f);
    for (const char* note : {"blending replaced", "1 occlusion texture ignored", "emissive material"}) CHECK(hasNote(scene, note));
    // "utilizes only the lower left quadrant of the source image, rotated clockwise 90 degrees"
    const TextureUse& use = material.baseColorTexture;
    CHECK(use.uvSet == 1);
    for (const Vec2& uv : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
        const Vec2 at = use.uvScaleRotation * uv + use.uvOffset;
        CHECK(at.x == Approx(0.5f * uv.y).margin(1e-6));
        CHECK(at.y == Approx(1.0f - 0.5f * uv.x).margin(1e-6));
    }
    const Texture& texture = *scene.textures.at(0);
    CHECK(texture.wrapS == Wrap::clampToEdge);
    CHECK(texture.wrapT == Wrap::mirroredRepeat);
    CHECK(texture.nearest);
    REQUIRE(texture.image.width == 2);
    CHECK(texture.image.at(0, 0) == Rgba8{255, 0, 0, 255});
    CHECK(texture.image.at(1, 0) == Rgba8{0, 255, 0, 255});
}

TEST_CASE("an image matters only if a triangle uses it", "[scene][gltf]")
{
    GltfBuilder b;
    b.json["images"] = {{{"uri", "missing.png"}}};
    b.json["textures"] = {{{"source", 0}}};
    b.json["materials"] = nlohmann::json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
    const Scene scene = b.load();
    CHECK(scene.textures.at(0)->image.empty());
    b.primitive()["material"] = 0;
    CHECK(b.error().find("images[0].uri") != std::string::npos);
    b.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
    CHECK(b.error().find("images[0]: \"image 0\" cannot be decoded") != std::string::npos);
    b.json["textures"] = nlohmann::json::parse("[{}]");  // {json} is an array to g++, a copy to clang++
    CHECK(hasNote(b.load(), "without a readable source"));
}

TEST_CASE("data URIs and files with escaped names hold the same bytes", "[scene][gltf]")
{
    const ScratchFolder folder;
    const char* json = R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "URI"}]})";
    const auto load = [&](const std::string& uri) {
        std::string text = json;
        text.replace(text.find("URI"), 3, uri);
        return loadGltf(folder.write("a.gltf", text), {}).meshes.at(0).positions;
    };
    const float values[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    folder.write("a b%c.bin", std::string_view(reinterpret_cast<const char*>(values), sizeof values));
    folder.write("$(touch x).bin", std::string_view(reinterpret_cast<const char*>(values), sizeof values));
    const auto expected = std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::string digits = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    for (const char* mediaType : {"application/octet-stream", "model/unheard-of", ""})
        CHECK(load("data:" + std::string(mediaType) + ";base64," + digits) == expected);
    CHECK(load("data:;base64," + digits + "AAA=") == expected);  // longer than promised
    CHECK(load("a%20b%25c.bin") == expected);
    CHECK(load("a b%c.bin") == expected);
    CHECK(load("$(touch x).bin") == expected);  // no shell looks at names
    for (const char* end : {"*", "A", "=A"}) CHECK_THROWS_AS(load("data:;base64," + digits + end), InputError);
    for (const char* bad : {"data:;base64,AAAA*AAA", "data:,plain", "http://host/a.bin", "none.bin", "a%00.bin", ".", ""}) {
        CAPTURE(bad);
        CHECK_THROWS_AS(load(bad), InputError);
    }
}
