#pragma once

#include "core/scene/gltf_asset.h"
#include "core/scene/gltf_document.h"

namespace lrsm::gltf {

/// After the meshes, whose influences the skins are held against. Refuses a node that is its own ancestor, or has two parents.
void readNodes(const Document& document, Asset& asset);
void readSkins(const Document& document, Asset& asset);
void readAnimations(const Document& document, Asset& asset);

}  // namespace lrsm::gltf
