#include "apps/common/describe.h"

#include "core/report/table.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 57.29577951308232;

const char* typeName(LightType type)
{
    switch (type) {
    case LightType::directional: return "directional";
    case LightType::spot: return "spot";
    case LightType::cubeFace: break;
    }
    return "cube face";
}

/// Four significant digits: for reading, not for computing.
std::string brief(double value)
{
    return numberText(4, value);
}

std::string brief(const Vec3& v)
{
    return "(" + brief(v.x) + ", " + brief(v.y) + ", " + brief(v.z) + ")";
}

std::string brief(const glm::dvec3& origin, const Vec3& place)
{
    if (origin == glm::dvec3(0.0)) return brief(place);
    // Every digit that the place has: four would hide it.
    const glm::dvec3 world = origin + glm::dvec3(place);
    char text[96];
    std::snprintf(text, sizeof text, "(%.10g, %.10g, %.10g)", world.x, world.y, world.z);
    return text;
}

std::string describe(const Light& light, const glm::dvec3& origin)
{
    std::string text = typeName(light.type);
    if (light.type == LightType::directional)
        text += ", direction " + brief(light.direction) + ", irradiance " + brief(light.intensity) + " W/m^2";
    else
        text += " at " + brief(origin, light.position) + ", direction " + brief(light.direction) + ", intensity " + brief(light.intensity) + " W/sr";
    if (light.type == LightType::spot)
        text += ", cone " + brief(light.innerConeAngle * kDegrees) + " .. " + brief(light.outerConeAngle * kDegrees) + " degrees";
    if (light.type == LightType::cubeFace) text += " (one of six that make a point light)";
    return text;
}

std::string describe(const Camera& camera, const glm::dvec3& origin)
{
    return std::string(camera.perspective ? "perspective" : "orthographic") + " at " + brief(origin, camera.position) + ", looking along " +
           brief(camera.forward) +
           (camera.perspective ? ", vertical field of view " + brief(camera.verticalFov * kDegrees) + " degrees"
                               : ", " + brief(camera.verticalExtent) + " m high");
}

std::size_t countDecoded(const Scene& scene)
{
    std::size_t count = 0;
    for (const SharedTexture& texture : scene.textures) count += !texture->image.empty();
    return count;
}

}  // namespace

std::string jsonText(const Json& json)
{
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json numberJson(double value)
{
    return std::isfinite(value) ? Json(value) : Json();
}

Json vectorJson(const Vec3& v)
{
    return {v.x, v.y, v.z};
}

Json vectorJson(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}

namespace {

/// In float's digits where the origin adds none.
Json placeJson(const Vec3& place, const glm::dvec3& origin)
{
    return origin == glm::dvec3(0.0) ? vectorJson(place) : vectorJson(origin + glm::dvec3(place));
}

}  // namespace

Json boxJson(const Aabb& box, const glm::dvec3& origin)
{
    if (box.empty()) return nullptr;
    return {{"min", placeJson(box.min, origin)}, {"max", placeJson(box.max, origin)}};
}

Json countersJson(const Counters& counters)
{
    Json json = Json::object();
    for (const Counter& counter : counters) {
        const bool whole = counter.value == std::floor(counter.value) && std::abs(counter.value) < 0x1p53;
        json[counter.name] = whole ? Json(static_cast<std::int64_t>(counter.value)) : numberJson(counter.value);
    }
    return json;
}

Json cameraJson(const Camera& camera, Angle angle, const glm::dvec3& origin)
{
    Json json = {{"name", camera.name},
                 {"position", placeJson(camera.position, origin)},
                 {"forward", vectorJson(camera.forward)},
                 {"up", vectorJson(camera.up)},
                 {"perspective", camera.perspective}};
    if (!camera.perspective)
        json["vertical_extent"] = camera.verticalExtent;
    else if (angle == Angle::radians)
        json["vertical_fov"] = camera.verticalFov;
    else
        json["vertical_fov_degrees"] = camera.verticalFov * kDegrees;
    json["near_plane"] = camera.nearPlane;
    return json;
}

Json lightJson(const Light& light, const glm::dvec3& origin)
{
    Json json = {{"name", light.name}, {"type", typeName(light.type)}, {"direction", vectorJson(light.direction)}, {"intensity", vectorJson(light.intensity)}};
    if (light.type != LightType::directional) json["position"] = placeJson(light.position, origin);
    if (light.type == LightType::spot) {
        json["inner_cone_angle_degrees"] = light.innerConeAngle * kDegrees;
        json["outer_cone_angle_degrees"] = light.outerConeAngle * kDegrees;
    }
    if (light.range < kInfinity) json["range"] = light.range;
    return json;
}

Json sceneJson(const Scene& scene, const std::string& sha256)
{
    Json json = {{"name", scene.name},
                 {"sha256", sha256},
                 {"meshes", scene.meshes.size()},
                 {"triangles", scene.triangleCount()},
                 {"materials", scene.materials.size()},
                 {"textures", scene.textures.size()},
                 {"textures_decoded", countDecoded(scene)},
                 {"origin", vectorJson(scene.origin)},
                 {"bounds", boxJson(scene.bounds, scene.origin)},
                 {"reach", boxJson(reachIsPart(scene) ? scene.reach : scene.bounds, scene.origin)},
                 {"lights", Json::array()},
                 {"cameras", Json::array()},
                 {"notes", scene.notes}};
    for (const Light& light : scene.lights) json["lights"].push_back(lightJson(light, scene.origin));
    for (const Camera& camera : scene.cameras) json["cameras"].push_back(cameraJson(camera, Angle::degrees, scene.origin));
    return json;
}

Json requirementsJson(const Requirements& needs)
{
    return {{"specular", needs.specular}, {"alpha_test", needs.alphaTest},       {"normal_maps", needs.normalMaps},
            {"textures", needs.textures}, {"vertex_colors", needs.vertexColors}, {"left_out", needs.leftOut}};
}

Json voxelGridsJson(const std::vector<VoxelGrid>& grids, const glm::dvec3& origin)
{
    Json list = Json::array();
    for (const VoxelGrid& grid : grids)
        list.push_back({{"corner", placeJson(grid.origin, origin)}, {"voxel_metres", grid.voxelSize}, {"resolution", grid.resolution}});
    return list;
}

Image<Vec3> worldPositions(const Scene& scene, const Image<Vec3>& position, const Image<float>& depth)
{
    Image<Vec3> world = position;
    if (scene.origin == glm::dvec3(0.0)) return world;
    for (std::size_t i = 0; i < world.texels.size(); ++i)
        if (depth.texels[i] != 0.0f) world.texels[i] = Vec3(worldPlace(scene, world.texels[i]));
    return world;
}

void printScene(std::ostream& out, const Scene& scene)
{
    out << scene.name << ": " << scene.meshes.size() << " meshes, " << scene.triangleCount() << " triangles, " << scene.materials.size() << " materials, "
        << scene.textures.size() << " textures (" << countDecoded(scene) << " used)\n"
        << "bounds: " << brief(scene.origin, scene.bounds.min) << " .. " << brief(scene.origin, scene.bounds.max) << " m\n";
    if (reachIsPart(scene))
        out << "reach: " << brief(scene.origin, scene.reach.min) << " .. " << brief(scene.origin, scene.reach.max)
            << " m: what camera and lights reach; voxel grid and light maps cover no more\n";
    if (scene.origin != glm::dvec3(0.0)) out << "origin: " << brief(scene.origin, Vec3(0.0f)) << " m: passes compute relative to it\n";
    out << "lights: " << scene.lights.size() << ", one LRSM each\n";
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        out << "  " << i << " \"" << scene.lights[i].name << "\": " << describe(scene.lights[i], scene.origin) << "\n";
    out << "cameras: " << scene.cameras.size() << "\n";
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        out << "  " << i << " \"" << scene.cameras[i].name << "\": " << describe(scene.cameras[i], scene.origin) << "\n";
    if (!scene.notes.empty()) out << "notes:\n";
    for (const std::string& note : scene.notes) out << "  " << note << "\n";
}

void printRequirements(std::ostream& out, const Requirements& needs)
{
    out << "left out, without changing a bit of the picture:\n";
    if (needs.leftOut.empty()) out << "  nothing\n";
    for (const std::string& line : needs.leftOut) out << "  " << line << "\n";
}

void printVoxelGrids(std::ostream& out, const std::vector<VoxelGrid>& grids, const glm::dvec3& origin)
{
    for (const VoxelGrid& grid : grids)
        out << "voxels: " << grid.resolution << "^3 of " << grid.voxelSize << " m, from " << brief(origin, grid.origin) << " on\n";
}

}  // namespace lrsm
