#include "core/scene/check_scene.h"

#include "core/base/errors.h"

#include <limits>
#include <sstream>

namespace lrsm {
namespace {

[[noreturn]] void refuse(const std::string& place, const char* field, double value, const char* allowed)
{
    std::ostringstream text;
    text << field << " = " << value << " must be " << allowed;
    throw InputError(place, text.str());
}

/// Written so that NaN is refused: every comparison with it is false.
void require(bool holds, const std::string& place, const char* field, double value, const char* allowed)
{
    if (!holds) refuse(place, field, value, allowed);
}

bool isPlace(const Vec3& p)
{
    const Vec3 a = glm::abs(p);
    return a.x <= kMaxCoordinate && a.y <= kMaxCoordinate && a.z <= kMaxCoordinate;
}

/// Unit, and across `axis`: a frame can be made of the two.
void checkFrame(const std::string& place, const char* axisName, const Vec3& axis, const Vec3& up)
{
    constexpr float kTolerance = 1e-3f;
    if (!(std::abs(glm::dot(axis, axis) - 1.0f) <= kTolerance)) throw InputError(place, std::string(axisName) + " must be a unit vector");
    if (!(std::abs(glm::dot(up, up) - 1.0f) <= kTolerance) || !(std::abs(glm::dot(axis, up)) <= kTolerance))
        throw InputError(place, std::string("up must be a unit vector at a right angle to ") + axisName);
}

void checkStreams(const Scene& scene, const Mesh& mesh)
{
    const std::string place = "mesh \"" + mesh.name + "\"";
    const std::size_t vertices = mesh.positions.size();
    if (mesh.material < 0 || std::size_t(mesh.material) >= scene.materials.size()) throw InputError(place, "its material is not in the scene");
    const auto fits = [&](std::size_t size) { return size == 0 || size == vertices; };
    if (mesh.normals.size() != vertices || !fits(mesh.tangents.size()) || !fits(mesh.uv0.size()) || !fits(mesh.uv1.size()) || !fits(mesh.colors.size()))
        throw InputError(place, "its vertex streams differ in length");

    std::uint32_t last = 0;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t v : triangle) last = std::max(last, v);
    if (!mesh.triangles.empty() && last >= vertices)
        throw InputError(place, "a triangle uses vertex " + std::to_string(last) + " of " + std::to_string(vertices));
}

}  // namespace

void checkBounds(const Aabb& bounds)
{
    if (bounds.empty()) return;
    if (!isPlace(bounds.min) || !isPlace(bounds.max))
        throw InputError("scene", "its bounds are not finite or reach beyond 1e15 m; remove the stray vertices or scale it down");
    const float longest = bounds.longestSide();
    require(longest == 0.0f || longest >= kMinSceneExtent, "scene", "longest side", longest, "0 or at least 1e-12 m; scale it up");
}

void checkLight(const Light& light)
{
    const std::string place = "light \"" + light.name + "\"";
    for (int c = 0; c < 3; ++c)
        require(light.intensity[c] >= 0.0f && light.intensity[c] <= std::numeric_limits<float>::max(), place, "intensity", double(light.intensity[c]),
                "finite and not negative");
    checkFrame(place, "direction", light.direction, light.up);
    if (light.type == LightType::directional) return;
    if (!isPlace(light.position)) throw InputError(place, "its position is not finite or beyond 1e15 m");
    require(light.range > 0.0f, place, "range", double(light.range), "above 0 m");
    if (light.type != LightType::spot) return;
    constexpr float kDegree = 0.0174532925f;
    require(light.outerConeAngle >= 1e-4f && light.outerConeAngle <= 1.00001f * kMaxOuterConeDegrees * kDegree, place, "outer cone angle",
            double(light.outerConeAngle), "in [0.0001, 1.5533] rad (89 degrees from the axis)");
    require(light.innerConeAngle >= 0.0f && light.innerConeAngle <= light.outerConeAngle, place, "inner cone angle", double(light.innerConeAngle),
            "in [0, outer cone angle]");
}

void checkCamera(const Camera& camera)
{
    const std::string place = "camera \"" + camera.name + "\"";
    if (!isPlace(camera.position)) throw InputError(place, "its position is not finite or beyond 1e15 m");
    checkFrame(place, "the direction of view", camera.forward, camera.up);
    if (camera.perspective) {
        require(camera.verticalFov >= 1e-4f && camera.verticalFov <= 3.1415f, place, "vertical field of view", double(camera.verticalFov),
                "in [0.0001, 3.1415] rad");
        require(camera.nearPlane > 0.0f && camera.nearPlane <= kMaxCoordinate, place, "near plane", double(camera.nearPlane), "above 0 and at most 1e15 m");
    } else {
        require(camera.verticalExtent >= kMinSceneExtent && camera.verticalExtent <= 2.0f * kMaxCoordinate, place, "vertical extent",
                double(camera.verticalExtent), "in [1e-12, 2e15] m");
        require(std::abs(camera.nearPlane) <= kMaxCoordinate, place, "near plane", double(camera.nearPlane), "finite");
    }
}

void checkMaterials(const Scene& scene)
{
    for (const Material& material : scene.materials) {
        const std::string place = "material \"" + material.name + "\"";
        require(material.metallic >= 0.0f && material.metallic <= 1.0f, place, "metallic", double(material.metallic), "in [0, 1]");
        require(material.roughness >= 0.0f && material.roughness <= 1.0f, place, "roughness", double(material.roughness), "in [0, 1]");
        for (int c = 0; c < 4; ++c)
            require(material.baseColor[c] >= 0.0f && material.baseColor[c] <= std::numeric_limits<float>::max(), place, "base colour",
                    double(material.baseColor[c]), "finite and not negative");
        require(std::abs(material.normalScale) <= 1e6f, place, "normal scale", double(material.normalScale), "in [-1e6, 1e6]");
    }
}

void checkScene(const Scene& scene)
{
    checkBounds(scene.bounds);
    checkMaterials(scene);
    for (const Light& light : scene.lights) checkLight(light);
    for (const Mesh& mesh : scene.meshes) checkStreams(scene, mesh);
}

}  // namespace lrsm
