#pragma once

#include "core/scene/gltf.h"

#include <optional>
#include <string>
#include <vector>

/// A view file names scene, camera and lights, for scene files that have none or not the wanted ones, and what moves:
///
///     {"scene": "sponza.glb",
///      "camera": {"eye": [x, y, z], "target": [x, y, z], "up": [0, 1, 0], "verticalFovDegrees": 45},
///      "lights": [{"type": "directional", "direction": [x, y, z], "color": [1, 1, 1], "intensity": 10},
///                 {"type": "spot", "position": [x, y, z], "target": [x, y, z], "color": [1, 1, 1], "intensity": 5,
///                  "innerConeAngleDegrees": 50, "outerConeAngleDegrees": 60}],
///      "materials": [{"name": "floor", "roughness": 0.2, "metallic": 0, "baseColor": [r, g, b]}],
///      "objects": [{"scene": "dragon.glb", "material": {"roughness": 0.5}, "position": [x, y, z],
///                   "keys": [{"time": 0, "yaw": 0}, {"time": 8, "yaw": 360}]}]}
///
/// Metres and degrees; intensity in W/m^2 (directional) or W/sr (spot, point) per channel of `color`. Cone angles are measured from the
/// axis, 0 <= inner < outer <= 89. Optional: up (0, 1, 0), verticalFovDegrees (45), color (white), intensity (1), inner (0) and outer (45)
/// angle, `range` in metres (none), `name`; a light of type "point" with `position` is split into six cube faces.
/// A material's values, those given, replace the scene's in all materials of that name, with the texture that they would be multiplied by; baseColor is linear.
/// An object is a glTF file, its meshes put at `position` (0), turned by `yaw` (0, degrees about +Y, counter-clockwise seen from above) and enlarged by `scale`
/// (1); `animation` (0, -1: none) plays in it; `material` changes all its materials.
///
/// Camera, lights and objects may have `keys` (view_keys.h): each a `time` in seconds and some of the numbers above, linear in time.
namespace lrsm {

/// What a view changes of a material.
struct MaterialChange {
    std::string name;
    std::optional<float> roughness, metallic;  ///< in [0, 1]
    std::optional<Vec3> baseColor;             ///< linear, in [0, 1]; alpha stays
};

struct ViewObject {
    std::string scene;  ///< as View::scene, a glTF file
    Placement placement;
    MaterialChange material;  ///< without a name
};

struct View {
    std::string scene;  ///< as the file has it: relative to the view file (or to the folder above it), or a built-in; empty if not given
    std::optional<Camera> camera;
    std::optional<std::vector<Light>> lights;  ///< at least one where present
    std::vector<MaterialChange> materials;
    std::vector<ViewObject> objects;
    std::vector<std::string> notes;
};

/// Throws InputError, after `place`, where the scene has no material of a change's name.
void changeMaterials(Scene& scene, const std::vector<MaterialChange>& changes, const std::string& place);
/// One material, whatever its name.
void changeMaterial(Material& material, const MaterialChange& change);

/// A view file as it was read.
struct ViewFile {
    std::string path, text;
    std::vector<double> keyTimes;  ///< seconds, of all keys, ascending; empty where nothing in it moves
};
/// Throws InputError "FILE: key: why" for anything but the above, at any of its key times; an unknown key is an error that names it.
ViewFile openViewFile(const std::string& path);

/// The view at `time`, seconds. Throws InputError where what is between two keys gives none (a direction that passes through 0). Places come out relative to
/// `origin`, metres.
View viewAt(const ViewFile& file, double time, const glm::dvec3& origin = glm::dvec3(0.0));

/// The same from text, unread before; `file` is for the messages.
View parseView(const std::string& text, const std::string& file, const glm::dvec3& origin = glm::dvec3(0.0), double time = 0.0);

}  // namespace lrsm
