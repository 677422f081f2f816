#include "core/scene/load_scene.h"

#include "core/base/errors.h"
#include "core/base/float_state.h"
#include "core/base/text.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/check_scene.h"
#include "core/scene/defaults.h"
#include "core/scene/reach.h"
#include "core/scene/view_file.h"

#include <algorithm>
#include <filesystem>
#include <optional>

namespace lrsm {
namespace {

std::string lowerCaseExtension(const std::string& path)
{
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return extension;
}

[[noreturn]] void failUnknown(const std::string& place)
{
    throw InputError(place, "there is no such file, and the built-in scenes are: " + joined(builtinScenes(), &BuiltinSceneInfo::name));
}

/// A built-in or a glTF file; `place` is where its name was given.
Scene loadPlain(const std::string& scene, const SceneOptions& options, const std::optional<Camera>& eye, const std::string& place)
{
    if (std::optional<Scene> builtin = makeBuiltinScene(scene)) return std::move(*builtin);
    std::error_code error;
    if (scene.empty() || !std::filesystem::exists(scene, error)) failUnknown(place);
    return loadGltf(scene, {.time = options.time, .animation = options.animation, .camera = options.camera, .eye = eye});
}

/// Beside the view file; else in the folder above, where views have a folder of their own among the scenes.
std::string sceneOfView(const std::string& scene, const std::string& viewPath)
{
    if (makeBuiltinScene(scene)) return scene;
    const std::filesystem::path folder = std::filesystem::path(viewPath).parent_path();
    const std::filesystem::path beside = folder / scene, above = folder / ".." / scene;
    std::error_code error;
    return (!std::filesystem::exists(beside, error) && std::filesystem::exists(above, error) ? above : beside).string();
}

/// For what the camera reaches, as far as depths over the whole scene can still be told apart.
float nearPlaneIn(const Scene& scene, const Camera& camera)
{
    const Vec3 far = glm::max(glm::abs(scene.bounds.min - camera.position), glm::abs(scene.bounds.max - camera.position));
    return std::max(nearPlaneFor(camera, measureReach(scene, camera)), float(1.01 / kMaxDepthRatio) * glm::length(far));
}

Scene loadWithView(const std::string& scene, const std::string& viewPath, const SceneOptions& options)
{
    View view = readViewFile(viewPath);
    std::string target = scene;
    if (target.empty()) {
        if (view.scene.empty()) throw InputError(viewPath + ": scene", "is missing");
        target = sceneOfView(view.scene, viewPath);
    }
    if (lowerCaseExtension(target) == ".json") throw InputError(viewPath + ": scene", "must not be a view file itself");

    Scene result = loadPlain(target, options, view.camera, (scene.empty() ? viewPath + ": " : "") + "scene \"" + target + "\"");
    if (result.origin != glm::dvec3(0.0)) view = readViewFile(viewPath, result.origin);
    if (view.camera) result.cameras = {*view.camera};
    if (view.lights) result.lights = std::move(*view.lights);
    changeMaterials(result, view.materials, viewPath);
    if (view.camera) result.cameras[0].nearPlane = nearPlaneIn(result, result.cameras[0]);
    // What was said about defaults no longer holds where the view replaced them.
    std::erase_if(result.notes,
                  [&](const std::string& note) { return (view.camera && note == kDefaultCameraNote) || (view.lights && note == kDefaultLightNote); });
    result.notes.insert(result.notes.end(), view.notes.begin(), view.notes.end());
    return result;
}

Scene loadAny(const std::string& scene, const SceneOptions& options)
{
    if (!options.view.empty()) return loadWithView(scene, options.view, options);
    if (lowerCaseExtension(scene) == ".json") return loadWithView("", scene, options);
    return loadPlain(scene, options, {}, "scene \"" + scene + "\"");
}

}  // namespace

Scene loadScene(const std::string& scene, const SceneOptions& options)
{
    const FloatState state;
    Scene loaded = loadAny(scene, options);
    loaded.reach = measureReach(loaded, findCamera(loaded, options.camera));
    return loaded;
}

}  // namespace lrsm
