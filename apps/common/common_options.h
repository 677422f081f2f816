#pragma once

#include "core/scene/load_scene.h"
#include "core/settings/settings.h"

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

/// What several subcommands take, so that it is called and checked the same everywhere.
namespace lrsm {

struct CommonOptions {
    // addSceneOptions
    std::string scene;  ///< file, view file or built-in
    std::string view;
    std::string camera;  ///< name or index
    float time = 0.0f;
    int animation = 0;
    std::string bounds = "auto";  ///< what Scene::reach is to be
    // addSettingOptions
    std::string preset = "balanced";
    std::string settingsFile;
    std::vector<std::string> assignments;
    // addPictureOptions
    std::string size = "1280x720";
    // addRunOptions
    int threads = 0;
    bool quiet = false, verbose = false;
    bool json = false;
};

void addSceneOptions(CLI::App& parser, CommonOptions& options);
/// The same for several scenes, which share view, camera and time; `scene` is theirs in turn.
void addScenesOptions(CLI::App& parser, CommonOptions& options, std::vector<std::string>& scenes);
void addSettingOptions(CLI::App& parser, CommonOptions& options);
void addPictureOptions(CLI::App& parser, CommonOptions& options);
void addRunOptions(CLI::App& parser, CommonOptions& options);

// Each throws InputError.
Scene loadChosenScene(const CommonOptions& options);
/// The same in two steps, for many moments: --time is not looked at.
SceneSource openChosenScene(const CommonOptions& options);
Scene poseChosenScene(const SceneSource& source, const CommonOptions& options, float time, KeptPoses* kept = nullptr);
const Camera& chosenCamera(const Scene& scene, const CommonOptions& options);
/// Preset, then file, then assignments in order; validated.
Settings chosenSettings(const CommonOptions& options);
/// "1280x720"; each side 1..16384.
IVec2 chosenSize(const CommonOptions& options);
/// Of --exposure: stops in [-100, 100]; nothing for "auto".
std::optional<float> parseExposure(const std::string& text);
/// "x,y" of a pixel inside the picture.
IVec2 parsePixel(const std::string& text, const IVec2& size);

}  // namespace lrsm
