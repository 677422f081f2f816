#pragma once

#include "core/scene/gltf_asset.h"
#include "core/scene/gltf_document.h"

namespace lrsm::gltf {

/// Materials, and textures still without images.
void readMaterials(const Document& document, Asset& asset);
void readImages(const Document& document, Asset& asset);

}  // namespace lrsm::gltf
