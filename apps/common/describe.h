#pragma once

#include "core/base/counters.h"
#include "core/base/image.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "voxel/bit_grid.h"

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

/// What is in a scene, for people and as JSON: shared by info, render, reference and captures.
namespace lrsm {

/// Indented, ending in a newline; bytes that are no UTF-8 (file names may hold any) become U+FFFD.
std::string jsonText(const nlohmann::ordered_json& json);

/// JSON has no infinity and no NaN: null.
nlohmann::ordered_json numberJson(double value);
nlohmann::ordered_json vectorJson(const Vec3& v);
nlohmann::ordered_json vectorJson(const glm::dvec3& v);
/// null where there is none.
nlohmann::ordered_json boxJson(const Aabb& box, const glm::dvec3& origin = glm::dvec3(0.0));
/// Whole numbers without a point; null where a value is not finite.
nlohmann::ordered_json countersJson(const Counters& counters);
/// The field of view in degrees is for people (vertical_fov_degrees); in radians it is the camera's to the last bit (vertical_fov).
enum class Angle { degrees, radians };
/// Places in the file's world: `origin` is added (Scene::origin).
nlohmann::ordered_json cameraJson(const Camera& camera, Angle angle = Angle::degrees, const glm::dvec3& origin = glm::dvec3(0.0));
nlohmann::ordered_json lightJson(const Light& light, const glm::dvec3& origin = glm::dvec3(0.0));
/// Name, hash, counts, bounds, reach, notes; the hash is `sha256` of the scene as loaded.
nlohmann::ordered_json sceneJson(const Scene& scene, const std::string& sha256);
nlohmann::ordered_json requirementsJson(const Requirements& needs);
/// Of each, finest first: its corner in the file's world, metres a voxel, voxels along an edge.
nlohmann::ordered_json voxelGridsJson(const std::vector<VoxelGrid>& grids, const glm::dvec3& origin);

/// A picture's positions in the file's world; 0 where its depth is.
Image<Vec3> worldPositions(const Scene& scene, const Image<Vec3>& position, const Image<float>& depth);

void printScene(std::ostream& out, const Scene& scene);
void printRequirements(std::ostream& out, const Requirements& needs);
void printVoxelGrids(std::ostream& out, const std::vector<VoxelGrid>& grids, const glm::dvec3& origin);

}  // namespace lrsm
