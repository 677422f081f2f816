#include "core/scene/gltf_asset.h"

#include "core/scene/gltf_accessor.h"
#include "core/scene/gltf_lights.h"
#include "core/scene/gltf_material.h"
#include "core/scene/gltf_mesh.h"
#include "core/scene/gltf_nodes.h"

namespace lrsm::gltf {
namespace {

void noteExtensions(const Document& document, Asset& asset)
{
    std::string ignored;
    for (const std::string& name : document.model.extensionsUsed)
        if (!isRead(name) && name != "KHR_materials_unlit" && name != "KHR_materials_emissive_strength")  // materials say it by name
            ignored += (ignored.empty() ? "" : ", ") + name;
    if (!ignored.empty()) asset.notes.push_back("extensions ignored: " + ignored);
}

}  // namespace

Asset readAsset(const std::string& path)
{
    const Document document = readDocument(path);
    checkAccessors(document);
    Asset asset;
    asset.file = path;
    asset.notes = document.notes;
    readMaterials(document, asset);
    readImages(document, asset);
    readMeshes(document, asset);
    readNodes(document, asset);
    readSkins(document, asset);
    readAnimations(document, asset);
    readLights(document, asset);
    readCameras(document, asset);
    noteExtensions(document, asset);
    return asset;
}

}  // namespace lrsm::gltf
