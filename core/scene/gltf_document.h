#pragma once

#include "core/base/errors.h"

#include <tiny_gltf.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// Private to the glTF loader: a file's JSON, checked, and its buffers.
namespace lrsm::gltf {

using Json = nlohmann::json;

struct Document {
    std::string file;       ///< as the user gave it
    Json json;              ///< obeys the schema (checkSchema)
    tinygltf::Model model;  ///< the same, typed; without buffers, images and extensions, which are read from `json`
    std::vector<std::vector<unsigned char>> buffers;
    bool quantized = false;  ///< KHR_mesh_quantization is used

    [[noreturn]] void fail(const std::string& jsonPath, const std::string& why) const { throw InputError(file + ": " + jsonPath, why); }
};

/// "name[3]"
std::string at(const std::string& path, std::size_t index);

/// Container, JSON, schema, buffers, cross references: all that can be said of a file before its data is looked at.
Document readDocument(const std::string& path);

/// Types, ranges and index targets of every property that is read, from one table. `document.json` must be parsed.
void checkSchema(const Document& document);
/// Ranges of buffer views and accessors, the node tree, skins, animations: what takes more than one property to see.
void checkReferences(const Document& document);

/// Bytes behind a URI: a data URI, or a file beside `document.file`. Throws InputError naming `jsonPath`.
std::vector<unsigned char> readUri(const Document& document, const std::string& uri, const std::string& jsonPath);

/// The bytes of a buffer view.
std::vector<unsigned char> bufferViewBytes(const Document& document, int view);

}  // namespace lrsm::gltf
