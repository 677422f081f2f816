#pragma once

#include "core/scene/scene.h"

#include <optional>
#include <string>

/// glTF 2.0 files (.gltf with its buffers and images, .glb) as a world-space Scene at one moment.
///
/// Read: triangles, strips and fans with their vertex streams; metallic-roughness materials with base colour, metallic-roughness and
/// normal textures; node, skin and morph target animation; cameras; KHR_lights_punctual, KHR_texture_transform, KHR_mesh_quantization.
/// What is skipped or replaced is said in Scene::notes.
namespace lrsm {

struct LoadOptions {
    float time = 0.0f;               ///< seconds; clamped to each animation sampler's range
    int animation = 0;               ///< index; -1: none, the nodes as the file has them
    std::string camera = "0";        ///< name or index of the one that will look: the scene's origin is chosen for it
    std::optional<Camera> eye = {};  ///< one that is not in the file, in its place; world space
};

/// Throws InputError "FILE: JSON path: why" for a file that is no valid glTF, that requires an extension unknown here, or that has
/// no triangle of positive area. A scene without lights or camera gets default ones (defaults.h). Textures are decoded only where a
/// triangle's material uses them. A scene far from 0 gets an origin (Scene::origin): it is subtracted in double, once. The result does not depend on the number
/// of threads.
Scene loadGltf(const std::string& path, const LoadOptions& options);

/// The camera of that name, else of that index ("0" the first). InputError lists the ones there are.
const Camera& findCamera(const Scene& scene, const std::string& nameOrIndex);

}  // namespace lrsm
