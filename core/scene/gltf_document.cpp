#include "core/scene/gltf_document.h"

#include "core/base/file.h"

#include <openssl/evp.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <string_view>

namespace lrsm::gltf {
namespace {

constexpr std::size_t kMaxJsonDepth = 128;  // recursion in the JSON library and in tinygltf; real files stay below 20

constexpr auto kUnderstoodExtensions = std::to_array<std::string_view>({"KHR_lights_punctual", "KHR_texture_transform", "KHR_mesh_quantization",
                                                                        // Ignored, with a note where it matters: these do not change what is modelled here.
                                                                        "KHR_materials_emissive_strength"});

std::uint32_t littleEndian32(const unsigned char* bytes)
{
    return std::uint32_t(bytes[0]) | std::uint32_t(bytes[1]) << 8 | std::uint32_t(bytes[2]) << 16 | std::uint32_t(bytes[3]) << 24;
}

struct Container {
    std::string_view json;
    std::vector<unsigned char> binary;
    bool hasBinary = false;
};

/// glTF 2.0, section 4.4: a header of 12 bytes, then chunks of length, type, data.
Container splitGlb(const Document& document, const std::vector<unsigned char>& file)
{
    constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
    if (file.size() < 12) document.fail("GLB", "the file ends inside the header");
    if (const std::uint32_t version = littleEndian32(&file[4]); version != 2)
        document.fail("GLB", "version " + std::to_string(version) + " is not supported, only 2");
    if (const std::uint32_t length = littleEndian32(&file[8]); length != file.size())
        document.fail("GLB", "the header says " + std::to_string(length) + " bytes, the file has " + std::to_string(file.size()));

    Container container;
    std::size_t at = 12;
    for (int chunk = 0; at < file.size(); ++chunk) {
        if (file.size() - at < 8) document.fail("GLB", "the file ends inside a chunk header");
        const std::size_t length = littleEndian32(&file[at]);
        const std::uint32_t type = littleEndian32(&file[at + 4]);
        at += 8;
        if (length > file.size() - at) document.fail("GLB", "chunk " + std::to_string(chunk) + " is longer than the file");
        if ((chunk == 0) != (type == kJsonChunk)) document.fail("GLB", "the first chunk, and no other, must be JSON");
        if (chunk == 0) container.json = {reinterpret_cast<const char*>(file.data() + at), length};
        if (chunk == 1 && type == kBinaryChunk) {
            container.binary.assign(file.begin() + std::ptrdiff_t(at), file.begin() + std::ptrdiff_t(at + length));
            container.hasBinary = true;
        }
        at += length;
    }
    if (container.json.empty()) document.fail("GLB", "there is no JSON chunk");
    return container;
}

/// Refuses nesting that would overflow a recursive reader's stack. Brackets inside strings do not count.
void checkDepth(const Document& document, std::string_view text)
{
    std::size_t depth = 0;
    bool inString = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (inString) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                inString = false;
        } else if (c == '"') {
            inString = true;
        } else if (c == '[' || c == '{') {
            if (++depth > kMaxJsonDepth) document.fail("JSON", "nested more than " + std::to_string(kMaxJsonDepth) + " deep");
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
    }
}

Json parseJson(const Document& document, std::string_view text)
{
    checkDepth(document, text);
    try {
        return Json::parse(text);
    } catch (const Json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 1, ...": the bracketed part tells a user nothing.
        std::string why = error.what();
        if (const std::size_t end = why.find("] "); end != std::string::npos) why.erase(0, end + 2);
        document.fail("JSON", why);
    }
}

void checkVersion(const Document& document)
{
    const auto major = [&](const std::string& key) {
        const std::string text = document.json["asset"][key].get<std::string>();
        const std::size_t dot = text.find('.');
        const auto digits = [](std::string_view part) {
            return !part.empty() && std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
        };
        if (dot == std::string::npos || !digits(text.substr(0, dot)) || !digits(text.substr(dot + 1))) document.fail("asset." + key, "must look like 2.0");
        return text;
    };
    if (!major("version").starts_with("2.")) document.fail("asset.version", "only glTF 2 is supported");
    if (document.json["asset"].contains("minVersion") && major("minVersion") != "2.0") document.fail("asset.minVersion", "only glTF 2.0 is supported");
}

void checkExtensions(const Document& document)
{
    std::string unknown;
    for (const Json& name : document.json.value("extensionsRequired", Json::array()))
        if (std::find(kUnderstoodExtensions.begin(), kUnderstoodExtensions.end(), name.get<std::string>()) == kUnderstoodExtensions.end())
            unknown += (unknown.empty() ? "" : ", ") + name.get<std::string>();
    if (!unknown.empty()) document.fail("extensionsRequired", "not supported: " + unknown);
}

/// What tinygltf shall not see: extensions and extras (read here, or not at all), and buffers and images, because its file access
/// expands names through the shell and looks in the working directory too.
void removeUnread(Json& value)
{
    if (value.is_object()) {
        value.erase("extensions");
        value.erase("extras");
    }
    if (value.is_structured())
        for (Json& child : value) removeUnread(child);
}

tinygltf::Model parseModel(const Document& document)
{
    Json json = document.json;
    json.erase("buffers");
    json.erase("images");
    removeUnread(json);
    const std::string text = json.dump();
    if (text.size() > 0x7fffffff) document.fail("JSON", "longer than 2 GiB");

    tinygltf::Model model;
    std::string error, warning;
    if (!tinygltf::TinyGLTF().LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "")) {
        std::replace(error.begin(), error.end(), '\n', ' ');
        document.fail("JSON", error);
    }
    return model;
}

std::vector<std::vector<unsigned char>> readBuffers(const Document& document, Container& container)
{
    std::vector<std::vector<unsigned char>> buffers;
    const Json list = document.json.value("buffers", Json::array());
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string path = at("buffers", i);
        if (list[i].contains("uri")) {
            buffers.push_back(readUri(document, list[i]["uri"].get<std::string>(), path + ".uri"));
        } else {
            if (i != 0 || !container.hasBinary) document.fail(path + ".uri", "is missing, and there is no binary chunk for it");
            buffers.push_back(std::move(container.binary));
        }
        const std::uint64_t promised = list[i]["byteLength"].get<std::uint64_t>();
        if (promised > buffers.back().size())
            document.fail(path + ".byteLength", std::to_string(promised) + " bytes promised, " + std::to_string(buffers.back().size()) + " there");
        buffers.back().resize(promised);
    }
    return buffers;
}

std::vector<unsigned char> decodeDataUri(const Document& document, std::string_view uri, const std::string& jsonPath)
{
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) document.fail(jsonPath, "a data URI must be base64");
    const std::string_view text = uri.substr(comma + 1);
    constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t digits = std::min(text.find_first_not_of(kAlphabet), text.size());
    const std::string_view padding = text.substr(digits);
    if (digits > 0x7ffffff0 || digits % 4 == 1 || !(padding.empty() || padding == "=" || padding == "==")) document.fail(jsonPath, "is no valid base64");

    std::string padded(text.substr(0, digits));
    const std::size_t missing = (4 - digits % 4) % 4;
    padded.append(missing, '=');
    std::vector<unsigned char> bytes(padded.size() / 4 * 3);
    if (EVP_DecodeBlock(bytes.data(), reinterpret_cast<const unsigned char*>(padded.data()), int(padded.size())) < 0)
        document.fail(jsonPath, "is no valid base64");
    bytes.resize(bytes.size() - missing);
    return bytes;
}

std::string percentDecode(const std::string& uri)
{
    const auto hex = [](char c) { return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1; };
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0) {
            text += char(hex(uri[i + 1]) * 16 + hex(uri[i + 2]));
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

}  // namespace

std::vector<unsigned char> readUri(const Document& document, const std::string& uri, const std::string& jsonPath)
{
    if (uri.starts_with("data:")) return decodeDataUri(document, uri, jsonPath);
    if (uri.find("://") != std::string::npos) document.fail(jsonPath, "only data URIs and files are read");
    const std::string name = percentDecode(uri);
    if (name.empty() || name.find('\0') != std::string::npos) document.fail(jsonPath, "is no file name");
    try {
        return readFile((std::filesystem::path(document.file).parent_path() / name).string());
    } catch (const InputError& error) {
        document.fail(jsonPath, error.what());
    }
}

std::vector<unsigned char> bufferViewBytes(const Document& document, int view)
{
    const tinygltf::BufferView& v = document.model.bufferViews[std::size_t(view)];
    const auto begin = document.buffers[std::size_t(v.buffer)].begin() + std::ptrdiff_t(v.byteOffset);
    return {begin, begin + std::ptrdiff_t(v.byteLength)};
}

Document readDocument(const std::string& path)
{
    Document document;
    document.file = path;
    const std::vector<unsigned char> file = readFile(path);

    Container container;
    if (file.size() >= 4 && std::memcmp(file.data(), "glTF", 4) == 0) {
        container = splitGlb(document, file);
    } else {
        container.json = {reinterpret_cast<const char*>(file.data()), file.size()};
        if (file.empty()) throw InputError(path, "is empty");
        const std::size_t first = container.json.find_first_not_of(" \t\r\n\xef\xbb\xbf");  // a byte order mark is tolerated
        if (first == std::string_view::npos || container.json[first] != '{') throw InputError(path, "is neither glTF JSON nor GLB");
    }
    document.json = parseJson(document, container.json);
    checkSchema(document);
    checkVersion(document);
    checkExtensions(document);
    for (const Json& name : document.json.value("extensionsUsed", Json::array())) document.quantized |= name.get<std::string>() == "KHR_mesh_quantization";
    document.buffers = readBuffers(document, container);
    document.model = parseModel(document);
    checkReferences(document);
    return document;
}

}  // namespace lrsm::gltf
