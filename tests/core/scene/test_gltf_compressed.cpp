// Compressed parts of glTF files: the scene is that of the plain file.
#include "core/scene/gltf.h"
#include "core/scene/scene_hash.h"

#include "catch.h"
#include "gltf_builder.h"

#include <meshoptimizer.h>
#include <webp/encode.h>

using namespace lrsm;

namespace {

using Json = nlohmann::json;

/// Two triangles over a unit square with one corner raised, by draco::Encoder: 11 bits of quantization, POSITION has id 0.
const std::vector<unsigned char> kDracoSquare = {0x44, 0x52, 0x41, 0x43, 0x4f, 0x02, 0x02, 0x01, 0x01, 0x00, 0x00, 0x00, 0x04, 0x02, 0x00, 0x02, 0x00,
                                                 0x00, 0x01, 0x1f, 0xff, 0x01, 0x11, 0x01, 0xff, 0x00, 0x00, 0x01, 0x00, 0x09, 0x03, 0x00, 0x00, 0x02,
                                                 0x01, 0x01, 0x01, 0x00, 0x0c, 0x03, 0x01, 0x20, 0x01, 0x10, 0x1f, 0x01, 0x10, 0x03, 0x00, 0x30, 0x90,
                                                 0x4a, 0x00, 0x10, 0x80, 0xff, 0x03, 0x00, 0x00, 0x00, 0x00, 0xff, 0x07, 0x00, 0x00, 0x00, 0x00, 0x00,
                                                 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x0b};

}  // namespace

TEST_CASE("a Draco primitive is its triangles, whatever its accessors hold", "[scene][gltf][compressed]")
{
    GltfBuilder b;
    b.json["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}}, {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 6}}};
    const int view = b.addView(kDracoSquare);
    b.primitive() = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"mode", 5}};
    b.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}};
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const Scene scene = b.load();
    CHECK(scene.triangleCount() == 2);
    CHECK(scene.bounds.min == Vec3(0));
    CHECK(glm::length(scene.bounds.max - Vec3(1, 1, 0.5f)) < 1e-3f);

    b.json["accessors"][0]["count"] = 5;
    CHECK(b.error().find("holds 4 elements, accessor 0 promises 5") != std::string::npos);
    b.json["accessors"][0]["count"] = 4;
    b.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 3;
    CHECK(b.error().find("KHR_draco_mesh_compression: cannot be decoded") != std::string::npos);
    b.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
    b.json["bufferViews"][0]["byteLength"] = 20;
    CHECK(b.error().find("cannot be decoded") != std::string::npos);
}

TEST_CASE("a meshopt view with a fallback buffer that no file holds is the plain view", "[scene][gltf][compressed]")
{
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::vector<unsigned char> encoded(meshopt_encodeVertexBufferBound(3, 12));
    encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), positions.data(), 3, 12));

    GltfBuilder b;
    const std::string plain = hashScene(b.load());
    const int at = b.addView(encoded);
    Json& view = b.json["bufferViews"][std::size_t(b.json["accessors"][0]["bufferView"].get<int>())];
    const auto extension = [&] {
        return Json{{"buffer", 0},      {"byteOffset", b.json["bufferViews"][std::size_t(at)]["byteOffset"]},
                    {"byteStride", 12}, {"byteLength", encoded.size()},
                    {"count", 3},       {"mode", "ATTRIBUTES"}};
    };
    view = {{"buffer", 1}, {"byteLength", 36}, {"byteStride", 12}, {"extensions", {{"EXT_meshopt_compression", extension()}}}};
    b.moreBuffers = {{{"byteLength", 36}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    CHECK(hashScene(b.load()) == plain);

    view["extensions"]["EXT_meshopt_compression"]["count"] = 400000000;
    CHECK(b.error().find("count: is more than its bytes can hold") != std::string::npos);
    view["extensions"]["EXT_meshopt_compression"]["count"] = 3;
    view["extensions"]["EXT_meshopt_compression"]["byteLength"] = 8;
    CHECK(b.error().find("EXT_meshopt_compression: cannot be decoded") != std::string::npos);
    view["extensions"]["EXT_meshopt_compression"]["mode"] = "POINTS";
    CHECK(b.error().find("must be one of ATTRIBUTES") != std::string::npos);
}

TEST_CASE("a WebP texture is read, by its extension and where an image is plainly one", "[scene][gltf][compressed]")
{
    const std::vector<unsigned char> rgba = {255, 0, 0, 255, 0, 255, 0, 128};
    unsigned char* output = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), 2, 1, 8, &output);
    std::vector<unsigned char> webp(output, output + size);
    WebPFree(output);

    GltfBuilder b;
    b.attributes()["TEXCOORD_0"] = b.add<float>({0, 0, 1, 0, 0, 1}, "VEC2", 5126);
    b.primitive()["material"] = 0;
    b.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    b.json["images"] = {{{"bufferView", b.addView(webp)}, {"mimeType", "image/webp"}}};
    for (const Json& texture : {Json{{"source", 0}}, Json{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}}) {
        b.json["textures"] = Json::array({texture});
        const Scene scene = b.load();
        REQUIRE(scene.textures[0]->image.texels.size() == 2);
        CHECK(scene.textures[0]->image.texels[1] == Rgba8{0, 255, 0, 128});
    }
    webp.resize(webp.size() - 6);
    b.json["images"] = {{{"bufferView", b.addView(webp)}}};
    CHECK(b.error().find("a damaged WebP file") != std::string::npos);
}
