#pragma once

#include "core/scene/gltf_asset.h"
#include "core/scene/gltf_document.h"

namespace lrsm::gltf {

void readCameras(const Document& document, Asset& asset);
void readLights(const Document& document, Asset& asset);

}  // namespace lrsm::gltf
