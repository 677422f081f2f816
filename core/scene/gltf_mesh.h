#pragma once

#include "core/scene/gltf_asset.h"
#include "core/scene/gltf_document.h"

namespace lrsm::gltf {

/// After the materials: a primitive without one takes the last.
void readMeshes(const Document& document, Asset& asset);

}  // namespace lrsm::gltf
