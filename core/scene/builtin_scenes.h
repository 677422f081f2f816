#pragma once

#include "core/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace lrsm {

struct BuiltinSceneInfo {
    std::string name;
    std::string summary;
};
/// The scenes made in code, in the order `lrsm info --list` shows them.
std::vector<BuiltinSceneInfo> builtinScenes();

/// `cornell-box` (the measured Cornell data), `two-rooms` (thin wall, spot in the left room), `atrium` (columns and thin curtains under a sun),
/// `furnace` (inside of a box, see its function), ... Each has lights and a camera. Nothing for an unknown name.
std::optional<Scene> makeBuiltinScene(const std::string& name);

}  // namespace lrsm
