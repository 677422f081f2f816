// Files that are broken: refused with one clear line, or, where the fault does not touch the picture, loaded.
#include "core/scene/gltf.h"

#include "catch.h"
#include "gltf_builder.h"
#include "scenes.h"

#include <fstream>
#include <iterator>
#include <map>

using namespace lrsm;

namespace {

std::string errorOf(const std::string& path)
{
    try {
        loadGltf(path, {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// The decision on each malformed file: what the error must say, or "" where it loads, and why.
const std::map<std::string, std::string> kDecisions = {
    {"assimp__BoxBadNormals.glb", ""},                     // normals are brought to unit length; wrong bounds are not read
    {"gltfrs__minimal_accessor_invalid.gltf", ""},         // wrong bounds are not read
    {"tinygltf__unassigned-skeleton.gltf", ""},            // targets and strides of buffer views do not matter; last rows of bind matrices
    {"tinygltf__zero-sized-bin-chunk-issue-440.glb", ""},  // valid
    {"assimp__RecursiveNodes.gltf", "nodes[0]: is its own ancestor"},
    {"assimp__badArray.gltf", "meshes[0].primitives: must be an array"},
    {"tinygltf__invalid-buffer-index.gltf", "bufferViews[1].buffer"},
    {"validator__accessor__alignment.gltf", "buffers[0].uri: is missing"},
    {"validator__accessor__invalid_sparse_count_and_stride.gltf", "buffers[0].uri: is missing"},
    {"validator__accessor__small_stride.gltf", "buffers[0].uri: is missing"},
    {"validator__accessor__unresolved_bufferviews.gltf", "accessors[0].bufferView"},
    {"validator__accessor_data__invalid_elements_float.gltf", "no triangles"},
    {"validator__animation__sampler_output_count_invalid.gltf", "animations[0].samplers[0].output"},
    {"validator__animation__unresolved_sampler_input.gltf", "animations[0].samplers[0].input"},
    {"validator__animation_data__invalid_input_values.gltf", "no triangles"},
    {"validator__asset__invalid_version.gltf", "asset.version"},
    {"validator__asset__min_version_invalid.gltf", "asset.minVersion"},
    {"validator__buffer__invalid_uri_data.gltf", "no triangles"},
    {"validator__buffer__no_bin_chunk.glb", "buffers[0].uri"},
    {"validator__buffer__wrong_bytelength.glb", "buffers[0].byteLength"},
    {"validator__buffer_view__invalid_length.gltf", "bufferViews[0]"},
    {"validator__camera__perspective_z.gltf", "no triangles"},
    {"validator__glb__chunk_too_big.glb", "GLB: the header says 13 bytes"},
    {"validator__glb__empty_file.glb", "is empty"},
    {"validator__glb__invalid_magic.glb", "neither glTF JSON nor GLB"},
    {"validator__glb__length_mismatch.glb", "GLB: the header says 49 bytes"},
    {"validator__glb__only_header.glb", "GLB: there is no JSON chunk"},
    {"validator__glb__truncated_chunk_data.glb", "GLB: the header says 48 bytes"},
    {"validator__image__invalid_image_data.gltf", "no triangles"},
    {"validator__image__not_found.gltf", "no triangles"},
    {"validator__json__bom.gltf", "no triangles"},
    {"validator__json__invalid_syntax.gltf", "is no JSON: line 1, column 2"},
    {"validator__lights__light__spot_invalid_angles.gltf", "lights[0].spot: innerConeAngle"},
    {"validator__lights__light__unknown_type.gltf", "lights[0].type"},
    {"validator__lights__light__valid.gltf", "no triangles"},
    {"validator__lights__node__unresolved_light_no_root_ext.gltf", "nodes[0].extensions.KHR_lights_punctual.light"},
    {"validator__material__unresolved_basecolor.gltf", "materials[0].pbrMetallicRoughness.baseColorTexture.index"},
    {"validator__mesh__accessor_unequal_count.gltf", "attributes.COLOR_0"},
    {"validator__mesh__position_accessor_invalid_format.gltf", "attributes.POSITION"},
    {"validator__mesh__primitive_no_position.gltf", "no triangles"},
    {"validator__mesh__unresolved_positions.gltf", "attributes.POSITION"},
    {"validator__mesh_data__index_buffer_oob.gltf", "meshes[0].primitives[0].indices: element 5 is 5"},
    {"validator__mesh_data__index_buffer_primitive_restart.gltf", "no triangles"},
    {"validator__node__infinite_transform.gltf", "number overflow"},
    {"validator__node__node_loop.gltf", "nodes[0]: is its own ancestor"},
    {"validator__node__unresolved_mesh.gltf", "nodes[0].mesh"},
    {"validator__root__invalid_collection_type.gltf", "samplers: must be an array"},
    {"validator__scene__unresolved_node.gltf", "scenes[0].nodes[0]"},
    {"validator__skin__ibm_invalid_count.gltf", "skins[2].inverseBindMatrices"},
    {"validator__skin__unresolved_joint.gltf", "skins[0].joints[0]"},
};

}  // namespace

TEST_CASE("every malformed file of other projects' tests ends as decided, in one line that names the file", "[scene][gltf][malformed]")
{
    LRSM_NEED_SCENES();
    std::size_t found = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scenesFolder() / "malformed")) {
        const std::string extension = entry.path().extension().string(), name = entry.path().filename().string();
        if (extension != ".gltf" && extension != ".glb") continue;
        ++found;
        CAPTURE(name);
        REQUIRE(kDecisions.count(name) == 1);
        const std::string error = errorOf(entry.path().string()), expected = kDecisions.at(name);
        if (expected.empty()) {
            CHECK(error == "");
            continue;
        }
        CHECK(error.find(expected) != std::string::npos);
        CHECK(error.find(name) != std::string::npos);
        CHECK(error.find('\n') == std::string::npos);
    }
    CHECK(found == kDecisions.size());
}

TEST_CASE("a file cut short anywhere, or with any byte changed, ends in an InputError or a scene", "[scene][gltf][malformed]")
{
    GltfBuilder b;
    b.attributes()["NORMAL"] = b.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
    b.primitive()["indices"] = b.add<std::uint16_t>({0, 1, 2}, "SCALAR", 5123);
    const std::string whole = b.glb();
    const ScratchFolder folder;
    REQUIRE(errorOf(folder.write("whole.glb", whole)) == "");
    for (std::size_t length = 0; length < whole.size(); ++length) CHECK(errorOf(folder.write("cut.glb", whole.substr(0, length))) != "");
    for (std::size_t i = 0; i < whole.size(); i += 3) {
        std::string changed = whole;
        changed[i] = char(changed[i] ^ (1 << (i % 8)));
        CHECK_NOTHROW(errorOf(folder.write("changed.glb", changed)));  // anything but an InputError would pass through
    }
    CHECK(errorOf(folder.write("longer.glb", whole + std::string(4, '\0'))).find("GLB: the header says") != std::string::npos);
}

TEST_CASE("a real file cut at every 64th byte is refused", "[scene][gltf][malformed]")
{
    LRSM_NEED_SCENES();
    std::ifstream stream(scenesFolder() / "cornell_box.glb", std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    const ScratchFolder folder;
    for (std::size_t length = 0; length < whole.size(); length += 64)
        CHECK(errorOf(folder.write("cut.glb", whole.substr(0, length))).find("cut.glb") != std::string::npos);
}

TEST_CASE("what is no file is said plainly", "[scene][gltf][malformed]")
{
    const ScratchFolder folder;
    folder.write("folder.glb/inside", "");
    CHECK(errorOf("").find("is empty") != std::string::npos);
    CHECK(errorOf(folder.path("none.glb")).find("there is no such file") != std::string::npos);
    CHECK(errorOf(folder.path("folder.glb")).find("is a folder") != std::string::npos);
    CHECK(errorOf("/dev/zero").find("no regular file") != std::string::npos);
    CHECK(errorOf(folder.write("empty.glb", "")).find("is empty") != std::string::npos);
    CHECK(errorOf(folder.write("text.glb", "hello")).find("neither glTF JSON nor GLB") != std::string::npos);
    CHECK(errorOf(folder.write("short.glb", "glTF")).find("ends inside the header") != std::string::npos);
}

TEST_CASE("each broken property is refused at its JSON path", "[scene][gltf][malformed]")
{
    using Json = nlohmann::json;
    struct Break {
        std::string pointer;  ///< JSON pointer of what is set
        Json value;
        std::string mustSay;
    };
    const double huge = 18446744073709551615.0;
    const std::vector<Break> breaks = {
        {"/asset", Json(), "asset"},
        {"/asset/version", "3.0", "asset.version"},
        {"/nodes", Json::object(), "nodes: must be an array"},
        {"/nodes/0", 3, "nodes[0]: must be an object"},
        {"/nodes/0/mesh", -1, "nodes[0].mesh"},
        {"/nodes/0/mesh", 1.5, "nodes[0].mesh"},
        {"/nodes/0/mesh", 4294967296, "nodes[0].mesh"},
        {"/nodes/0/children", {0}, "nodes[0]"},
        {"/nodes/0/translation", {0, 0}, "nodes[0].translation"},
        {"/nodes/0/rotation", {0, 0, 0, 0}, "nodes[0].rotation"},
        {"/nodes/0/scale", {1e300, 1, 1}, "not finite"},
        {"/nodes/0/scale", {0, 0, 0}, "no triangle of the scene has an area"},
        {"/nodes/0/scale", {1e30, 1, 1}, "larger than 1e15"},
        {"/nodes/0/matrix", {1}, "nodes[0].matrix"},
        {"/scene", 1, "scene"},
        {"/scenes/0/nodes/0", 1, "scenes[0].nodes[0]"},
        {"/scenes/0/nodes", Json::array(), "no triangles"},
        {"/accessors/0/count", 4, "accessors[0]: reaches past the end"},
        {"/accessors/0/count", 0, "accessors[0].count"},
        {"/accessors/0/count", 4294967295, "accessors[0]: reaches past the end"},
        {"/accessors/0/count", huge, "accessors[0].count"},
        {"/accessors/0/byteOffset", 4, "accessors[0]: reaches past the end"},
        {"/accessors/0/byteOffset", 9007199254740992, "accessors[0]: reaches past the end"},
        {"/accessors/0/byteOffset", -4, "accessors[0].byteOffset"},
        {"/accessors/0/componentType", 5124, "accessors[0].componentType"},
        {"/accessors/0/type", "VEC5", "accessors[0].type"},
        {"/accessors/0/type", "VEC2", "attributes.POSITION"},
        {"/bufferViews/0/byteOffset", 9007199254740992, "bufferViews[0]: reaches past the end"},
        {"/bufferViews/0/byteLength", 9007199254740992, "bufferViews[0]: reaches past the end"},
        {"/bufferViews/0/byteStride", 8, "byteStride is smaller than an element"},
        {"/bufferViews/0/byteStride", 14, "accessors[0]: reaches past the end"},
        {"/bufferViews/0/byteStride", 252, "accessors[0]: reaches past the end"},
        {"/meshes/0/primitives/0/mode", 7, "primitives[0].mode"},
        {"/meshes/0/primitives/0/indices", 9, "primitives[0].indices"},
        {"/meshes/0/primitives/0/indices", 0, "primitives[0].indices"},
        {"/meshes/0/primitives/0/material", 0, "primitives[0].material"},
        {"/meshes/0/primitives/0/attributes/JOINTS_0", 0, "attributes.JOINTS_0"},
        {"/materials", Json::parse(R"([{"pbrMetallicRoughness": {"metallicFactor": 2}}])"), "materials[0].pbrMetallicRoughness.metallicFactor"},
        {"/materials", Json::parse(R"([{"normalTexture": {}}])"), "materials[0].normalTexture.index"},
        {"/cameras", Json::parse(R"([{"type": "perspective", "perspective": {"yfov": -1, "znear": 1}}])"), "cameras[0].perspective.yfov"},
        {"/skins", Json::parse(R"([{"joints": []}])"), "skins[0].joints: is empty"},
        {"/extensionsRequired", {"X_unknown"}, "X_unknown"},
    };
    for (const Break& item : breaks) {
        GltfBuilder b;
        b.json[Json::json_pointer(item.pointer)] = item.value;
        const std::string error = b.error();
        CAPTURE(item.pointer, item.value.dump(), error);
        CHECK(error.find(item.mustSay) != std::string::npos);
        CHECK(error.find('\n') == std::string::npos);
    }
}

TEST_CASE("a NaN or infinity in the data names the accessor", "[scene][gltf][malformed]")
{
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity}) {
        GltfBuilder b;
        b.attributes()["POSITION"] = b.add<float>({0, 0, 0, 1, bad, 0, 0, 1, 0}, "VEC3", 5126);
        CHECK(b.error().find("accessors[1]: element 1 is not finite") != std::string::npos);
    }
}

TEST_CASE("an accessor that costs the file nothing cannot ask for all memory", "[scene][gltf][malformed]")
{
    GltfBuilder b;
    b.json["accessors"][0].erase("bufferView");
    b.json["accessors"][0]["count"] = 4294967295u;
    CHECK(b.error().find("accessors[0].count") != std::string::npos);
}

TEST_CASE("deep nesting is refused before anything recurses", "[scene][gltf][malformed]")
{
    const ScratchFolder folder;
    std::string deep = R"({"asset": {"version": "2.0"}, "extras": )";
    for (const char* pair : {"[]", "{}"}) {
        std::string text = deep;
        for (int i = 0; i < 200000; ++i) text += pair[0] == '[' ? "[" : "{\"a\":";
        CHECK(errorOf(folder.write("deep.gltf", text)).find("nested more than") != std::string::npos);
    }
    CHECK(errorOf(folder.write("string.gltf", deep + "\"" + std::string(1000, '[') + "\"}")).find("no triangles") != std::string::npos);
}

TEST_CASE("shared children, two parents and loops are refused", "[scene][gltf][malformed]")
{
    GltfBuilder b;
    b.json["nodes"] = {{{"mesh", 0}, {"children", {1, 2}}}, {{"children", {2}}}, nlohmann::json::object()};
    CHECK(b.error().find("already has a parent") != std::string::npos);
    b.json["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}};
    CHECK(b.error().find("nodes[1]: is its own ancestor") != std::string::npos);
    b.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, nlohmann::json::object()};
    b.json["scenes"][0]["nodes"] = {1};
    CHECK(b.error().find("is another node's child") != std::string::npos);
}
