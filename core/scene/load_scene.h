#pragma once

#include "core/scene/gltf.h"
#include "core/scene/scene.h"
#include "core/scene/scene_hash.h"
#include "core/scene/view_file.h"

#include <optional>
#include <string>
#include <vector>

namespace lrsm {

struct SceneOptions {
    float time = 0.0f;         ///< seconds, for animated files
    int animation = 0;         ///< index; -1: none
    std::string view = {};     ///< a view file whose camera and lights replace the scene's; empty: none
    std::string camera = "0";  ///< name or index of the one that will look: origin and reach are measured for it
};

/// What SCENE of the command line names, read once: a scene for each moment is posed from it.
struct SceneSource {
    SceneOptions options;                ///< but its time
    std::optional<Scene> builtin;        ///< either this
    GltfFile file;                       ///< or that
    std::optional<ViewFile> view;        ///< over it
    std::vector<GltfFile> objects = {};  ///< one for each of the view's; those of one path are one file
};
SceneSource openScene(const std::string& scene, const SceneOptions& options);

/// What was posed last of one source, file by file.
struct KeptPoses {
    PosedFile file;
    std::vector<PosedFile> objects;
};

/// The scene at `time`, seconds: a function of source and time alone, equal to the bit to that of a source opened anew. What stands as in
/// `kept` is copied from there.
Scene poseScene(const SceneSource& source, float time, KeptPoses* kept = nullptr);

/// The last second at which anything moves, of keys and animations; 0 where nothing does.
double endOfMotion(const SceneSource& source);

/// Throws InputError where the view has none at `time`, without posing anything: all frames are asked before the first is rendered.
void checkMoment(const SceneSource& source, float time);

/// SCENE of the command line: a built-in scene's name, a .gltf or .glb file, or a view file (.json). With `options.view` the scene may
/// be empty: the view file's own is meant. Scene::origin and Scene::reach are measured. Throws InputError; for a name that is neither file nor built-in it
/// lists the built-ins. The two above in one.
Scene loadScene(const std::string& scene, const SceneOptions& options);

}  // namespace lrsm
