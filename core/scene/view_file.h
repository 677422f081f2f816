#pragma once

#include "core/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

/// A view file names scene, camera and lights, for scene files that have none or not the wanted ones:
///
///     {"scene": "sponza.glb",
///      "camera": {"eye": [x, y, z], "target": [x, y, z], "up": [0, 1, 0], "verticalFovDegrees": 45},
///      "lights": [{"type": "directional", "direction": [x, y, z], "color": [1, 1, 1], "intensity": 10},
///                 {"type": "spot", "position": [x, y, z], "target": [x, y, z], "color": [1, 1, 1], "intensity": 5,
///                  "innerConeAngleDegrees": 50, "outerConeAngleDegrees": 60}],
///      "materials": [{"name": "floor", "roughness": 0.2, "metallic": 0, "baseColor": [r, g, b]}]}
///
/// Metres and degrees; intensity in W/m^2 (directional) or W/sr (spot, point) per channel of `color`. Cone angles are measured from the
/// axis, 0 <= inner < outer <= 89. Optional: up (0, 1, 0), verticalFovDegrees (45), color (white), intensity (1), inner (0) and outer (45)
/// angle, `range` in metres (none), `name`; a light of type "point" with `position` is split into six cube faces.
/// A material's values, those given, replace the scene's in all materials of that name, with the texture that they would be multiplied by; baseColor is linear.
namespace lrsm {

/// What a view changes of a material.
struct MaterialChange {
    std::string name;
    std::optional<float> roughness, metallic;  ///< in [0, 1]
    std::optional<Vec3> baseColor;             ///< linear, in [0, 1]; alpha stays
};

struct View {
    std::string scene;  ///< as the file has it: relative to the view file (or to the folder above it), or a built-in; empty if not given
    std::optional<Camera> camera;
    std::optional<std::vector<Light>> lights;  ///< at least one where present
    std::vector<MaterialChange> materials;
    std::vector<std::string> notes;
};

/// Throws InputError, after `place`, where the scene has no material of a change's name.
void changeMaterials(Scene& scene, const std::vector<MaterialChange>& changes, const std::string& place);

/// Throws InputError "FILE: key: why" for anything but the above; an unknown key is an error that names it. Places come out relative to `origin`, metres.
View readViewFile(const std::string& path, const glm::dvec3& origin = glm::dvec3(0.0));

/// The same from text; `file` is for the messages.
View parseView(const std::string& text, const std::string& file, const glm::dvec3& origin = glm::dvec3(0.0));

}  // namespace lrsm
