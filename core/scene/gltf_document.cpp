#include "core/scene/gltf_document.h"

#include "core/base/file.h"
#include "core/decode/decode.h"
#include "core/scene/gltf_compressed.h"
#include "core/scene/gltf_repair.h"
#include "core/scene/gltf_schema.h"
#include "core/scene/gltf_uri.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace lrsm::gltf {
namespace {

constexpr auto kReadExtensions =
    std::to_array<std::string_view>({"KHR_lights_punctual", "KHR_texture_transform", "KHR_mesh_quantization", "KHR_materials_pbrSpecularGlossiness",
                                     "EXT_mesh_gpu_instancing", "EXT_texture_webp", "EXT_meshopt_compression", "KHR_draco_mesh_compression"});
/// A file may require these: without them its shapes and colours are there, if not all that happens on its surfaces.
constexpr auto kHarmlessExtensions = std::to_array<std::string_view>(
    {"KHR_materials_unlit", "KHR_materials_emissive_strength", "KHR_materials_clearcoat", "KHR_materials_sheen", "KHR_materials_specular", "KHR_materials_ior",
     "KHR_materials_iridescence", "KHR_materials_anisotropy", "KHR_materials_dispersion", "KHR_materials_transmission", "KHR_materials_volume",
     "KHR_materials_diffuse_transmission", "KHR_materials_variants", "KHR_xmp_json_ld", "KHR_xmp", "EXT_lights_image_based"});

struct Conversion {
    std::string_view extension, advice;
};
/// What another program makes readable.
constexpr auto kConversions = std::to_array<Conversion>({
    {"KHR_texture_basisu", "decompress its KTX2 textures first, for instance with `gltf-transform ktxdecompress IN OUT`"},
    {"EXT_texture_avif", "convert its textures to PNG, JPEG or WebP first"},
    {"KHR_meshopt_compression", "write it with EXT_meshopt_compression, or without compression"},
});

struct Container {
    std::string_view json;
    std::optional<std::span<const unsigned char>> binary;
};

/// glTF 2.0, section 4.4: a header of 12 bytes, then chunks of length, type, data.
Container splitGlb(const Document& document, std::span<const unsigned char> file)
{
    constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
    const auto word = [&](std::size_t offset) {
        std::uint32_t value = 0;
        std::memcpy(&value, &file[offset], sizeof value);
        return value;
    };
    if (file.size() < 12) document.fail("GLB", "the file ends inside the header");
    if (word(4) != 2) document.fail("GLB", "version " + std::to_string(word(4)) + " is not supported, only 2");
    if (word(8) != file.size()) document.fail("GLB", "the header says " + std::to_string(word(8)) + " bytes, the file has " + std::to_string(file.size()));

    Container container;
    for (std::size_t begin = 12, chunk = 0; begin < file.size(); ++chunk) {
        if (file.size() - begin < 8) document.fail("GLB", "the file ends inside a chunk header");
        const std::uint32_t length = word(begin), type = word(begin + 4);
        begin += 8;
        if (length > file.size() - begin) document.fail("GLB", "chunk " + std::to_string(chunk) + " is longer than the file");
        if ((chunk == 0) != (type == kJsonChunk)) document.fail("GLB", "the first chunk, and no other, must be JSON");
        const std::span<const unsigned char> data = file.subspan(begin, length);
        if (chunk == 0) container.json = {reinterpret_cast<const char*>(data.data()), data.size()};
        if (chunk == 1 && type == kBinaryChunk) container.binary = data;
        begin += length;
    }
    if (container.json.empty()) document.fail("GLB", "there is no JSON chunk");
    return container;
}

Container splitFile(const Document& document, const std::vector<unsigned char>& file)
{
    constexpr unsigned char kMagic[] = {'g', 'l', 'T', 'F'};
    if (file.size() >= 4 && std::equal(std::begin(kMagic), std::end(kMagic), file.begin())) return splitGlb(document, file);
    if (file.empty()) throw InputError(document.file, "is empty");
    const std::string_view json(reinterpret_cast<const char*>(file.data()), file.size());
    const std::size_t first = json.find_first_not_of(" \t\r\n\xef\xbb\xbf");  // a byte order mark is tolerated
    if (first == std::string_view::npos || json[first] != '{') throw InputError(document.file, "is neither glTF JSON nor GLB");
    return {json, {}};
}

void checkVersion(const JsonReader& asset)
{
    constexpr const char* kDigits = "0123456789";
    for (const char* key : {"version", "minVersion"}) {
        if (!asset.has(key)) continue;
        const std::string text = asset[key].text();
        const std::size_t dot = text.find_first_not_of(kDigits);
        if (dot == 0 || dot >= text.size() - 1 || text[dot] != '.' || text.find_first_not_of(kDigits, dot + 1) != std::string::npos)
            asset.fail(key, "must look like 2.0");
    }
    if (!asset["version"].text().starts_with("2.")) asset.fail("version", "only glTF 2 is supported");
    if (asset.has("minVersion") && asset["minVersion"].text() != "2.0") asset.fail("minVersion", "only glTF 2.0 is supported");
}

void checkExtensions(const Document& document)
{
    std::string unknown, advice;
    for (const Json& json : document.json.value("extensionsRequired", Json::array())) {
        const std::string name = json.get<std::string>();
        if (isRead(name) || std::find(kHarmlessExtensions.begin(), kHarmlessExtensions.end(), name) != kHarmlessExtensions.end()) continue;
        unknown += (unknown.empty() ? "" : ", ") + name;
        advice += conversionAdvice(name);
    }
    if (!unknown.empty()) document.fail("extensionsRequired", "not supported: " + unknown + advice);
}

/// tinygltf does not see extensions and extras (newer ones interpret more of them than the schema checks), buffers and images, and strides, of which it
/// refuses some that can be read.
Json seenByTinygltf(const Json& value, bool isRoot)
{
    if (!value.is_structured()) return value;
    Json copy = value.is_array() ? Json::array() : Json::object();
    if (value.is_array())
        for (const Json& item : value) copy.push_back(seenByTinygltf(item, false));
    else
        for (const auto& [key, member] : value.items())
            if (key != "extensions" && key != "extras" && key != "byteStride" && !(isRoot && (key == "buffers" || key == "images")))
                copy[key] = seenByTinygltf(member, false);
    return copy;
}

tinygltf::Model parseModel(const Document& document)
{
    const std::string text = seenByTinygltf(document.json, true).dump();
    if (text.size() > 0x7fffffff) document.fail("JSON", "longer than 2 GiB");

    tinygltf::Model model;
    std::string error, warning;
    if (!tinygltf::TinyGLTF().LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "")) {
        std::replace(error.begin(), error.end(), '\n', ' ');
        document.fail("JSON", error);
    }
    for (std::size_t i = 0; i < model.bufferViews.size(); ++i)
        model.bufferViews[i].byteStride = document.json["bufferViews"][i].value("byteStride", std::size_t(0));
    return model;
}

std::vector<std::vector<unsigned char>> readBuffers(const Document& document, const Container& container)
{
    std::vector<std::vector<unsigned char>> buffers;
    const Json list = document.json.value("buffers", Json::array());
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string path = at("buffers", i);
        if (list[i].contains("uri")) {
            buffers.push_back(readUri(document, list[i]["uri"].get<std::string>(), path + ".uri"));
        } else if (isFallbackBuffer(list[i])) {
            buffers.emplace_back();
            continue;
        } else {
            if (i != 0 || !container.binary) document.fail(path + ".uri", "is missing, and there is no binary chunk for it");
            buffers.emplace_back(container.binary->begin(), container.binary->end());
        }
        const std::uint64_t promised = list[i]["byteLength"].get<std::uint64_t>();
        if (promised > buffers.back().size())
            document.fail(path + ".byteLength", std::to_string(promised) + " bytes promised, " + std::to_string(buffers.back().size()) + " there");
        buffers.back().resize(promised);
    }
    return buffers;
}

std::vector<unsigned char> decodeDataUri(const Document& document, const std::string& uri, const std::string& jsonPath)
{
    const std::optional<std::string> plain = plainDataUri(uri);
    if (!plain) document.fail(jsonPath, uri.find("base64,") == std::string::npos ? "a data URI must be base64" : "is no valid base64");
    std::string text = plain->substr(plain->find(',') + 1);
    while (text.ends_with('=')) text.pop_back();

    // tinygltf knows some media types only, stops without a word at what is no digit, and counts in int.
    std::vector<unsigned char> bytes;
    std::string mediaType;
    if (text.size() < 0x7ffffff0) tinygltf::DecodeDataURI(&bytes, mediaType, "data:application/octet-stream;base64," + text, 0, false);
    if (text.size() % 4 == 1 || bytes.size() != text.size() * 3 / 4) document.fail(jsonPath, "is no valid base64");
    return bytes;
}

}  // namespace

std::string at(const std::string& path, std::size_t index)
{
    return path + "[" + std::to_string(index) + "]";
}

std::string countOf(std::size_t count, const std::string& noun)
{
    if (count == 1) return "1 " + noun;
    if (noun == "vertex") return std::to_string(count) + " vertices";
    return std::to_string(count) + " " + noun + "s";
}

std::vector<unsigned char> readUri(const Document& document, const std::string& uri, const std::string& jsonPath)
{
    if (isDataUri(uri)) return decodeDataUri(document, uri, jsonPath);
    if (uri.find("://") != std::string::npos) document.fail(jsonPath, "only data URIs and files are read");
    const std::string name = decodeUri(uri);
    if (name.empty() || name.find('\0') != std::string::npos) document.fail(jsonPath, "is no file name");
    try {
        return readFile((std::filesystem::path(document.file).parent_path() / name).string());
    } catch (const InputError& error) {
        document.fail(jsonPath, error.what());
    }
}

std::string conversionAdvice(std::string_view extension)
{
    for (const Conversion& conversion : kConversions)
        if (conversion.extension == extension) return "; " + std::string(conversion.advice);
    return "";
}

bool isRead(std::string_view extension)
{
    const bool compressed = extension == "EXT_meshopt_compression" || extension == "KHR_draco_mesh_compression" || extension == "EXT_texture_webp";
    return (hasDecoders() || !compressed) && std::find(kReadExtensions.begin(), kReadExtensions.end(), extension) != kReadExtensions.end();
}

Document readDocument(const std::string& path)
{
    const std::vector<unsigned char> file = readFile(path);
    Document document;
    document.file = path;
    const Container container = splitFile(document, file);
    document.json = parseJson(container.json, container.json.data() == reinterpret_cast<const char*>(file.data()) ? path : path + ": JSON chunk");
    repairJson(document.json, path, document.notes);
    const JsonReader root(document.json, path);
    checkSchema(root);
    checkVersion(root["asset"]);
    checkExtensions(document);
    document.buffers = readBuffers(document, container);
    if (hasDecoders()) decompress(document);
    document.model = parseModel(document);
    return document;
}

}  // namespace lrsm::gltf
