#include "core/scene/gltf_compressed.h"

#include "core/decode/decode.h"

#include <cstring>

namespace lrsm::gltf {
namespace {

constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// The extension's object; none where there is none.
const Json* extensionOf(const Json& owner, const char* name)
{
    const auto extensions = owner.find("extensions");
    if (extensions == owner.end()) return nullptr;
    const auto found = extensions->find(name);
    return found == extensions->end() ? nullptr : &*found;
}

std::span<const unsigned char> bytesIn(const Document& document, std::size_t buffer, std::uint64_t offset, std::uint64_t length, const std::string& path)
{
    const std::vector<unsigned char>& bytes = document.buffers[buffer];
    if (offset > bytes.size() || length > bytes.size() - offset) document.fail(path, "reaches past the end of buffer " + std::to_string(buffer));
    return std::span(bytes).subspan(offset, length);
}

std::size_t addBuffer(Document& document, Bytes bytes)
{
    document.json["buffers"].push_back({{"byteLength", bytes.size()}});
    document.buffers.push_back(std::move(bytes));
    return document.buffers.size() - 1;
}

std::size_t addView(Document& document, Bytes bytes)
{
    const std::size_t length = bytes.size(), buffer = addBuffer(document, std::move(bytes));
    document.json["bufferViews"].push_back({{"buffer", buffer}, {"byteLength", length}});
    return document.json["bufferViews"].size() - 1;
}

MeshoptStream meshoptStream(const Json& json)
{
    using Mode = MeshoptStream::Mode;
    using Filter = MeshoptStream::Filter;
    const std::string mode = json["mode"].get<std::string>(), filter = json.value("filter", "NONE");
    return {.mode = mode == "ATTRIBUTES"  ? Mode::attributes
                    : mode == "TRIANGLES" ? Mode::triangles
                                          : Mode::indices,
            .filter = filter == "OCTAHEDRAL"    ? Filter::octahedral
                      : filter == "QUATERNION"  ? Filter::quaternion
                      : filter == "EXPONENTIAL" ? Filter::exponential
                                                : Filter::none,
            .count = json["count"].get<std::size_t>(),
            .stride = json["byteStride"].get<std::size_t>()};
}

void decompressView(Document& document, std::size_t i)
{
    const Json* json = extensionOf(document.json["bufferViews"][i], kMeshopt);
    if (!json) return;
    const std::string path = at("bufferViews", i) + ".extensions." + kMeshopt;
    const MeshoptStream stream = meshoptStream(*json);
    // A byte of the file holds a few hundred of the result at most: a file cannot ask for all memory.
    constexpr std::uint64_t kMaxRatio = 4096;
    const auto bytes = bytesIn(document, json->at("buffer").get<std::size_t>(), json->value("byteOffset", std::uint64_t(0)),
                               json->at("byteLength").get<std::uint64_t>(), path);
    if (stream.count > bytes.size() * kMaxRatio) document.fail(path + ".count", "is more than its bytes can hold");
    std::optional<Bytes> decoded = decodeMeshopt(bytes, stream);
    if (!decoded) document.fail(path, "cannot be decoded: it is damaged, or of a newer version of the format");
    const std::size_t length = decoded->size(), buffer = addBuffer(document, std::move(*decoded));
    Json& view = document.json["bufferViews"][i];
    view["buffer"] = buffer;
    view["byteOffset"] = 0;
    view["byteLength"] = length;
    if (stream.mode == MeshoptStream::Mode::attributes) view["byteStride"] = stream.stride;
}

int componentsOf(const std::string& type)
{
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
}

/// The accessor reads `bytes` from now on.
void repoint(Document& document, std::size_t accessor, Bytes bytes, std::size_t count, const std::string& path)
{
    Json& json = document.json["accessors"][accessor];
    if (json["count"].get<std::size_t>() != count)
        document.fail(path, "holds " + std::to_string(count) + " elements, accessor " + std::to_string(accessor) + " promises " + json["count"].dump());
    const std::size_t view = addView(document, std::move(bytes));
    Json& same = document.json["accessors"][accessor];
    same["bufferView"] = view;
    same["byteOffset"] = 0;
    same.erase("sparse");
}

Bytes asBytes(const std::vector<std::uint32_t>& indices)
{
    Bytes bytes(indices.size() * sizeof indices[0]);
    std::memcpy(bytes.data(), indices.data(), bytes.size());
    return bytes;
}

void decompressPrimitive(Document& document, std::size_t mesh, std::size_t p)
{
    const Json primitive = document.json["meshes"][mesh]["primitives"][p];
    const Json* json = extensionOf(primitive, kDraco);
    if (!json || primitive.value("mode", 4) < 4) return;
    const std::string path = at(at("meshes", mesh) + ".primitives", p) + ".extensions." + kDraco;

    std::vector<DracoAttribute> wanted;
    std::vector<std::size_t> accessors;
    for (const auto& [name, id] : json->at("attributes").items()) {
        const auto accessor = primitive["attributes"].find(name);
        if (accessor == primitive["attributes"].end()) continue;
        accessors.push_back(accessor->get<std::size_t>());
        const Json& form = document.json["accessors"][accessors.back()];
        wanted.push_back(
            {.id = id.get<std::uint32_t>(), .componentType = form["componentType"].get<int>(), .components = componentsOf(form["type"].get<std::string>())});
    }
    const Json& view = document.json["bufferViews"][json->at("bufferView").get<std::size_t>()];
    std::optional<DracoMesh> decoded = decodeDraco(
        bytesIn(document, view["buffer"].get<std::size_t>(), view.value("byteOffset", std::uint64_t(0)), view["byteLength"].get<std::uint64_t>(), path),
        wanted);
    if (!decoded) document.fail(path, "cannot be decoded: it is damaged, or lacks an attribute that is asked for");
    for (std::size_t a = 0; a < wanted.size(); ++a) repoint(document, accessors[a], std::move(decoded->attributes[a]), decoded->points, path);

    // Its triangles are a list, whatever the primitive's mode and indices say.
    const std::size_t count = decoded->indices.size();
    if (count == 0) document.fail(path, "holds no triangle");
    const std::size_t accessor = document.json["accessors"].size(), indices = addView(document, asBytes(decoded->indices));
    document.json["accessors"].push_back({{"bufferView", indices}, {"componentType", 5125}, {"type", "SCALAR"}, {"count", count}});
    Json& changed = document.json["meshes"][mesh]["primitives"][p];
    changed["indices"] = accessor;
    changed["mode"] = 4;
}

}  // namespace

bool isFallbackBuffer(const Json& buffer)
{
    const Json* json = extensionOf(buffer, kMeshopt);
    return json && !buffer.contains("uri");
}

void decompress(Document& document)
{
    const std::size_t views = document.json.contains("bufferViews") ? document.json["bufferViews"].size() : 0;
    for (std::size_t i = 0; i < views; ++i) decompressView(document, i);
    const std::size_t meshes = document.json.contains("meshes") ? document.json["meshes"].size() : 0;
    for (std::size_t m = 0; m < meshes; ++m)
        for (std::size_t p = 0; p < document.json["meshes"][m]["primitives"].size(); ++p) decompressPrimitive(document, m, p);
}

}  // namespace lrsm::gltf
