#pragma once

#include "core/base/json_reader.h"

namespace lrsm::gltf {

/// Types, ranges and index targets of every property that is read, from one table. InputError "FILE: nodes[0].mesh: why".
void checkSchema(const JsonReader& root);

}  // namespace lrsm::gltf
