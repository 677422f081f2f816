#include "apps/common/common_options.h"

#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include <charconv>
#include <cmath>

namespace lrsm {

namespace {

/// Two whole numbers around one of the separators; nothing else in the text.
bool parsePair(const std::string& text, const char* separators, IVec2& pair)
{
    const std::size_t at = text.find_first_of(separators);
    if (at == std::string::npos) return false;
    const char *begin = text.data(), *middle = begin + at, *end = begin + text.size();
    const auto first = std::from_chars(begin, middle, pair.x), second = std::from_chars(middle + 1, end, pair.y);
    return first.ec == std::errc() && first.ptr == middle && second.ec == std::errc() && second.ptr == end;
}

/// Six numbers between commas; nothing else in the text.
bool parseBox(const std::string& text, glm::dvec3& min, glm::dvec3& max)
{
    const char *at = text.data(), *end = at + text.size();
    for (int i = 0; i < 6; ++i) {
        double& value = i < 3 ? min[i] : max[i - 3];
        const auto parsed = std::from_chars(at, end, value);
        if (parsed.ec != std::errc() || !std::isfinite(value)) return false;
        at = parsed.ptr;
        if (i < 5 && (at == end || *at++ != ',')) return false;
    }
    return at == end;
}

/// Lays --bounds over what was measured.
void forceReach(Scene& scene, const std::string& bounds)
{
    if (bounds == "auto") return;
    scene.reach = scene.bounds;
    if (bounds == "scene") return;
    glm::dvec3 min, max;
    if (!parseBox(bounds, min, max) || !glm::all(glm::lessThan(min, max)))
        throw InputError("--bounds " + bounds, "must be auto, scene, or six numbers x,y,z,x,y,z: the least corner, then the greatest");
    scene.reach = {Vec3(min - scene.origin), Vec3(max - scene.origin)};
}

constexpr const char* kSceneHelp = "a .gltf, .glb or view .json file, or a built-in scene (lrsm info --list)";

void addViewOptions(CLI::App& parser, CommonOptions& options)
{
    parser.add_option("--view", options.view, "view file: scene, camera and lights");
    parser.add_option("--camera", options.camera, "camera by name or index");
    parser.add_option("--time", options.time, "seconds into the animation");
    parser.add_option("--animation", options.animation, "index of the animation; -1: none");
    parser
        .add_option(
            "--bounds", options.bounds,
            "what voxel grid and light maps cover: auto (what camera and lights reach, where that is far less than the scene), scene, or x,y,z,x,y,z in metres")
        ->capture_default_str();
}

}  // namespace

void addSceneOptions(CLI::App& parser, CommonOptions& options)
{
    parser.add_option("SCENE", options.scene, kSceneHelp);
    addViewOptions(parser, options);
}

void addScenesOptions(CLI::App& parser, CommonOptions& options, std::vector<std::string>& scenes)
{
    parser.add_option("SCENE", scenes, std::string(kSceneHelp) + "; several are allowed");
    addViewOptions(parser, options);
}

void addSettingOptions(CLI::App& parser, CommonOptions& options)
{
    parser
        .add_option("--preset", options.preset,
                    "literal, paper, fast, balanced, fine, accurate, rays, vct, vct-paper, caches, caches-paper, proxies, proxies-paper or ism")
        ->capture_default_str();
    parser.add_option("--settings", options.settingsFile, "JSON file of settings over the preset (a frame.json serves)");
    parser.add_option("--set", options.assignments, "key=value over both; repeatable, later wins (lrsm settings lists them)")->allow_extra_args(false);
}

void addPictureOptions(CLI::App& parser, CommonOptions& options)
{
    parser.add_option("--size", options.size, "WxH in pixels")->capture_default_str();
}

void addRunOptions(CLI::App& parser, CommonOptions& options)
{
    parser.add_option("--threads", options.threads, "0: all the machine has; the picture does not depend on it")->check(CLI::Range(0, 1024))->type_name("N");
    parser.add_flag("-q,--quiet", options.quiet, "no progress, no summary");
    parser.add_flag("-v,--verbose", options.verbose, "every note on the scene, not one a kind");
    parser.add_flag("--json", options.json, "JSON on standard output");
}

Scene loadChosenScene(const CommonOptions& options)
{
    if (!std::isfinite(options.time)) throw InputError("--time", "must be a finite number of seconds");
    return poseChosenScene(openChosenScene(options), options, options.time);
}

SceneSource openChosenScene(const CommonOptions& options)
{
    return openScene(options.scene, {.animation = options.animation, .view = options.view, .camera = options.camera.empty() ? "0" : options.camera});
}

Scene poseChosenScene(const SceneSource& source, const CommonOptions& options, float time, KeptPoses* kept)
{
    Scene scene = poseScene(source, time, kept);
    forceReach(scene, options.bounds);
    return scene;
}

const Camera& chosenCamera(const Scene& scene, const CommonOptions& options)
{
    return findCamera(scene, options.camera.empty() ? "0" : options.camera);
}

Settings chosenSettings(const CommonOptions& options)
{
    Settings settings = preset(options.preset);
    if (!options.settingsFile.empty()) applySettingsFile(settings, options.settingsFile);
    for (const std::string& assignment : options.assignments) applySetting(settings, assignment);
    validate(settings);
    return settings;
}

IVec2 chosenSize(const CommonOptions& options)
{
    constexpr int kMax = 16384;
    IVec2 size(0);
    if (!parsePair(options.size, "xX", size) || size.x < 1 || size.y < 1 || size.x > kMax || size.y > kMax)
        throw InputError("--size " + options.size, "must be WxH with sides of 1 .. " + std::to_string(kMax) + " pixels, as 1280x720");
    return size;
}

std::optional<float> parseExposure(const std::string& text)
{
    if (text == "auto") return {};
    float stops = 0.0f;
    if (!CLI::detail::lexical_cast(text, stops) || !(std::abs(stops) <= 100.0f)) throw InputError("--exposure " + text, "must be auto or stops in [-100, 100]");
    return stops;
}

IVec2 parsePixel(const std::string& text, const IVec2& size)
{
    IVec2 pixel(0);
    if (!parsePair(text, ",", pixel) || pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y)
        throw InputError("--pixel " + text,
                         "must be x,y inside the picture of " + std::to_string(size.x) + "x" + std::to_string(size.y) + ", counted from the top left");
    return pixel;
}

}  // namespace lrsm
