#pragma once

#include "core/scene/gltf.h"
#include "core/scene/scene.h"
#include "core/scene/scene_hash.h"

#include <string>

namespace lrsm {

struct SceneOptions {
    float time = 0.0f;         ///< seconds, for animated files
    int animation = 0;         ///< index; -1: none
    std::string view;          ///< a view file whose camera and lights replace the scene's; empty: none
    std::string camera = "0";  ///< name or index of the one that will look: origin and reach are measured for it
};

/// SCENE of the command line: a built-in scene's name, a .gltf or .glb file, or a view file (.json). With `options.view` the scene may
/// be empty: the view file's own is meant. Scene::origin and Scene::reach are measured. Throws InputError; for a name that is neither file nor built-in it
/// lists the built-ins.
Scene loadScene(const std::string& scene, const SceneOptions& options);

}  // namespace lrsm
