#pragma once

#include "core/scene/gltf_asset.h"
#include "core/scene/gltf_document.h"

#include <string>

/// Private to the glTF loader: the steps from a checked document to an asset.
namespace lrsm::gltf {

/// The whole file, validated and parsed; images still encoded. Throws InputError.
Asset readAsset(const std::string& path);

void readMaterials(const Document& document, Asset& asset);
void readImages(const Document& document, Asset& asset);
void readMeshes(const Document& document, Asset& asset);
void readNodes(const Document& document, Asset& asset);
void readSkins(const Document& document, Asset& asset);
void readAnimations(const Document& document, Asset& asset);
void readCameras(const Document& document, Asset& asset);
void readLights(const Document& document, Asset& asset);

/// "1 primitive", "3 primitives"
std::string countOf(std::size_t count, const std::string& noun);

}  // namespace lrsm::gltf
