#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lrsm::gltf {

/// Mends what common writers get wrong and every other loader lets pass, before the JSON is checked: null values, whole numbers written as 3.0, strides of 0,
/// unknown wrap modes, ranges of 0, base64 with line breaks or in the alphabet of URLs, back-slashes in file names (`file`: the glTF file, beside which
/// they lie). A note a kind says what was done.
void repairJson(nlohmann::ordered_json& json, const std::string& file, std::vector<std::string>& notes);

}  // namespace lrsm::gltf
