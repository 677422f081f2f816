#pragma once

#include "core/base/errors.h"

#include <tiny_gltf.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// Private to the glTF loader: a file's JSON, checked, and its buffers.
///
/// What stands in front of tinygltf, and why (2.7.0, Debian 12's; the malformed files and the fuzzer hold it): it reads and refuses a lot, but names no index,
/// so every type, range and target is checked before by one table (gltf_schema.cpp). It would read past the end of a GLB cut inside its binary
/// chunk and refuse an empty one, index buffers by image views that it has not checked, ask the shell and the working directory for file names, refuse
/// buffer files longer than promised, and fail for an image that nothing uses: containers, buffers and images are read here. Base64, the typed model and
/// the decoding of images are its own.
namespace lrsm::gltf {

using Json = nlohmann::ordered_json;

struct Document {
    std::string file;       ///< as the user gave it
    Json json;              ///< mended (gltf_repair.h), decompressed (gltf_compressed.h), and obeys the schema (checkSchema)
    tinygltf::Model model;  ///< the same, typed; without buffers, images and extensions, which are read from `json`
    std::vector<std::vector<unsigned char>> buffers;
    std::vector<std::string> notes;  ///< what was mended on the way

    [[noreturn]] void fail(const std::string& jsonPath, const std::string& why) const { throw InputError(file + ": " + jsonPath, why); }
};

/// "name[3]"
std::string at(const std::string& path, std::size_t index);

/// "1 primitive", "3 primitives"
std::string countOf(std::size_t count, const std::string& noun);

/// Is what an extension says read here, or does it not matter to what is modelled?
bool isRead(std::string_view extension);

/// "; what to do" for an extension that another program can take out of a file; "" for others.
std::string conversionAdvice(std::string_view extension);

/// Container, JSON, schema, extensions, buffers; what the accessors and nodes refer to is checked where they are read.
Document readDocument(const std::string& path);

/// Bytes behind a URI: a data URI, or a file beside `document.file`. Throws InputError naming `jsonPath`.
std::vector<unsigned char> readUri(const Document& document, const std::string& uri, const std::string& jsonPath);

}  // namespace lrsm::gltf
