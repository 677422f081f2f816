#include "core/scene/load_scene.h"

#include "core/base/errors.h"
#include "core/base/float_state.h"
#include "core/base/text.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/check_scene.h"
#include "core/scene/defaults.h"
#include "core/scene/reach.h"

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
void openPlain(SceneSource& source, const std::string& scene, const std::string& place)
{
    source.builtin = makeBuiltinScene(scene);
    if (source.builtin && source.options.animation > 0)
        throw InputError("animation " + std::to_string(source.options.animation), "the built-in scene " + scene + " has none");
    if (source.builtin) return;
    std::error_code error;
    if (scene.empty() || !std::filesystem::exists(scene, error)) failUnknown(place);
    source.file = openGltf(scene);
}

/// Beside the view file; else in the folder above, where views have a folder of their own among the scenes; else beside `scene`.
std::string fileOfView(const std::string& file, const std::string& viewPath, const std::string& scene = "")
{
    const std::filesystem::path folder = std::filesystem::path(viewPath).parent_path();
    std::error_code error;
    for (const std::filesystem::path& candidate : {folder / file, folder / ".." / file, std::filesystem::path(scene).parent_path() / file})
        if (std::filesystem::exists(candidate, error)) return candidate.string();
    return (folder / file).string();
}

void openObjects(SceneSource& source, const std::string& scene)
{
    const std::vector<ViewObject> objects = viewAt(*source.view, 0.0).objects;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const std::string place = source.view->path + ": objects[" + std::to_string(i) + "].scene";
        const auto same = std::find_if(objects.begin(), objects.begin() + std::ptrdiff_t(i), [&](const ViewObject& o) { return o.scene == objects[i].scene; });
        if (same != objects.begin() + std::ptrdiff_t(i)) {
            source.objects.push_back(source.objects[std::size_t(same - objects.begin())]);
            continue;
        }
        const std::string extension = lowerCaseExtension(objects[i].scene), path = fileOfView(objects[i].scene, source.view->path, scene);
        if (extension != ".glb" && extension != ".gltf") throw InputError(place, "\"" + objects[i].scene + "\" must be a .gltf or .glb file");
        std::error_code error;
        if (!std::filesystem::exists(path, error)) throw InputError(place, "there is no file \"" + path + "\"");
        source.objects.push_back(openGltf(path));
    }
}

void openWithView(SceneSource& source, const std::string& scene, const std::string& viewPath)
{
    source.view = openViewFile(viewPath);
    std::string target = scene;
    if (target.empty()) {
        target = viewAt(*source.view, 0.0).scene;
        if (target.empty()) throw InputError(viewPath + ": scene", "is missing");
        if (!makeBuiltinScene(target)) target = fileOfView(target, viewPath);
    }
    if (lowerCaseExtension(target) == ".json") throw InputError(viewPath + ": scene", "must not be a view file itself");
    openPlain(source, target, (scene.empty() ? viewPath + ": " : "") + "scene \"" + target + "\"");
    openObjects(source, target);
}

/// For what the camera reaches, as far as depths over the whole scene can still be told apart.
float nearPlaneIn(const Scene& scene, const Camera& camera)
{
    const Vec3 far = glm::max(glm::abs(scene.bounds.min - camera.position), glm::abs(scene.bounds.max - camera.position));
    return std::max(nearPlaneFor(camera, measureReach(scene, camera)), float(1.01 / kMaxDepthRatio) * glm::length(far));
}

void addObjects(Scene& scene, const SceneSource& source, const View& view, float time, KeptPoses* kept)
{
    if (kept) kept->objects.resize(view.objects.size());
    for (std::size_t i = 0; i < view.objects.size(); ++i) {
        const std::size_t first = addPlaced(scene, *source.objects[i], view.objects[i].placement, time, kept ? &kept->objects[i] : nullptr);
        for (std::size_t m = first; m < scene.materials.size(); ++m) changeMaterial(scene.materials[m], view.objects[i].material);
    }
}

Scene posePlain(const SceneSource& source, float time, const std::optional<Camera>& eye, KeptPoses* kept)
{
    if (source.builtin) return *source.builtin;
    return poseGltf(*source.file, {.time = time, .animation = source.options.animation, .camera = source.options.camera, .eye = eye},
                    kept ? &kept->file : nullptr);
}

Scene poseWithView(const SceneSource& source, float time, KeptPoses* kept)
{
    View view = viewAt(*source.view, double(time));
    Scene result = posePlain(source, time, view.camera, kept);
    if (result.origin != glm::dvec3(0.0)) view = viewAt(*source.view, double(time), result.origin);
    changeMaterials(result, view.materials, source.view->path);
    addObjects(result, source, view, time, kept);
    if (view.camera) result.cameras = {*view.camera};
    if (view.lights) result.lights = std::move(*view.lights);
    if (view.camera) result.cameras[0].nearPlane = nearPlaneIn(result, result.cameras[0]);
    // What was said about defaults no longer holds where the view replaced them.
    std::erase_if(result.notes,
                  [&](const std::string& note) { return (view.camera && note == kDefaultCameraNote) || (view.lights && note == kDefaultLightNote); });
    result.notes.insert(result.notes.end(), view.notes.begin(), view.notes.end());
    return result;
}

}  // namespace

SceneSource openScene(const std::string& scene, const SceneOptions& options)
{
    const FloatState state;
    SceneSource source{.options = options, .builtin = {}, .file = {}, .view = {}};
    if (!options.view.empty())
        openWithView(source, scene, options.view);
    else if (lowerCaseExtension(scene) == ".json")
        openWithView(source, "", scene);
    else
        openPlain(source, scene, "scene \"" + scene + "\"");
    return source;
}

Scene poseScene(const SceneSource& source, float time, KeptPoses* kept)
{
    const FloatState state;
    Scene posed = source.view ? poseWithView(source, time, kept) : posePlain(source, time, {}, kept);
    posed.reach = measureReach(posed, findCamera(posed, source.options.camera));
    return posed;
}

double endOfMotion(const SceneSource& source)
{
    double end = source.view && !source.view->keyTimes.empty() ? std::max(source.view->keyTimes.back(), 0.0) : 0.0;
    if (source.file) end = std::max(end, lengthOfAnimation(*source.file, source.options.animation));
    if (source.objects.empty()) return end;
    const std::vector<ViewObject> objects = viewAt(*source.view, 0.0).objects;
    for (std::size_t i = 0; i < objects.size(); ++i) end = std::max(end, lengthOfAnimation(*source.objects[i], objects[i].placement.animation));
    return end;
}

void checkMoment(const SceneSource& source, float time)
{
    if (source.view) viewAt(*source.view, double(time));
}

Scene loadScene(const std::string& scene, const SceneOptions& options)
{
    return poseScene(openScene(scene, options), options.time);
}

}  // namespace lrsm
