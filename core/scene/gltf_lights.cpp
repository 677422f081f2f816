#include "core/scene/gltf_lights.h"

namespace lrsm::gltf {
namespace {

/// An RSM of a spot light is one perspective view: wider than this it has hardly a texel left for the middle.
constexpr float kMaxOuterConeAngle = 1.5533430f;  // 89 degrees

void readCone(const Document& document, const Json& json, const std::string& path, Light& light, Asset& asset)
{
    constexpr float kRounding = 1e-3f;  // of the angle: what conversions between degrees, radians and float leave
    const auto spot = json.find("spot");
    if (spot == json.end()) {
        asset.notes.push_back("light \"" + light.name + "\": without cone angles, so the default ones are taken");
        return;
    }
    light.innerConeAngle = spot->value("innerConeAngle", 0.0f);
    light.outerConeAngle = spot->value("outerConeAngle", 0.78539816f);
    if (light.innerConeAngle > light.outerConeAngle * (1.0f + kRounding)) document.fail(path + ".spot", "innerConeAngle must be smaller than outerConeAngle");
    if (light.innerConeAngle >= light.outerConeAngle) {
        asset.notes.push_back("light \"" + light.name + "\": inner cone angle as large as the outer: a hard edge");
        light.innerConeAngle = light.outerConeAngle;
    }
    if (light.outerConeAngle >= kMaxOuterConeAngle) {
        asset.notes.push_back("light \"" + light.name + "\": outer cone angle reduced to 89 degrees");
        light.outerConeAngle = kMaxOuterConeAngle;
        light.innerConeAngle = std::min(light.innerConeAngle, 0.999f * kMaxOuterConeAngle);
    }
}

}  // namespace

void readLights(const Document& document, Asset& asset)
{
    const auto extensions = document.json.find("extensions");
    if (extensions == document.json.end() || !extensions->contains("KHR_lights_punctual")) return;
    const Json& lights = (*extensions)["KHR_lights_punctual"]["lights"];
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const std::string path = at("extensions.KHR_lights_punctual.lights", i);
        const std::string type = lights[i]["type"].get<std::string>();
        LocalLight local;
        Light& light = local.light;
        light.name = lights[i].value("name", "light " + std::to_string(i));
        light.type = type == "directional" ? LightType::directional : LightType::spot;
        local.point = type == "point";
        const std::vector<float> color = lights[i].value("color", std::vector<float>{1.0f, 1.0f, 1.0f});
        light.intensity = Vec3(color[0], color[1], color[2]) * lights[i].value("intensity", 1.0f);
        if (light.type != LightType::directional) light.range = lights[i].value("range", kInfinity);
        if (type == "spot") readCone(document, lights[i], path, light, asset);
        asset.lights.push_back(std::move(local));
    }
}

void readCameras(const Document& document, Asset& asset)
{
    for (const tinygltf::Camera& source : document.model.cameras) {
        Camera camera;
        camera.name = source.name;
        camera.perspective = source.type == "perspective";
        camera.nearPlane = float(camera.perspective ? source.perspective.znear : source.orthographic.znear);
        if (camera.perspective) {
            camera.verticalFov = float(source.perspective.yfov);
            camera.aspect = float(source.perspective.aspectRatio);
        } else {
            // A negative magnification mirrors the picture; glTF discourages it, and the size is all that is kept.
            const float xmag = std::abs(float(source.orthographic.xmag)), ymag = std::abs(float(source.orthographic.ymag));
            if (!(xmag > 0.0f && ymag > 0.0f)) document.fail(at("cameras", asset.cameras.size()) + ".orthographic", "xmag and ymag must not be 0");
            camera.verticalExtent = 2.0f * ymag;
            camera.aspect = xmag / ymag;
        }
        asset.cameras.push_back(std::move(camera));
    }
}

}  // namespace lrsm::gltf
