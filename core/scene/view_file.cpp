#include "core/scene/view_file.h"

#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/base/json_reader.h"
#include "core/base/text.h"
#include "core/scene/defaults.h"
#include "core/scene/light.h"
#include "core/scene/view_keys.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr double kDegree = 0.017453292519943295;

float numberOr(float fallback, const JsonReader& in, const char* key, double min, double max)
{
    return in.has(key) ? float(in[key].number(min, max)) : fallback;
}

std::string textOr(const std::string& fallback, const JsonReader& in, const char* key)
{
    return in.has(key) ? in[key].text() : fallback;
}

Vec3 vectorOf(const JsonReader& in)
{
    const Vec3 v = in.vector();
    if (glm::length(v) > 1e15f) in.fail("is larger than 1e15");
    return v;
}

/// A place, relative to `origin`: subtracted before it is rounded.
Vec3 placeOf(const JsonReader& in, const glm::dvec3& origin)
{
    vectorOf(in);  // refuses what is none
    const auto xyz = in.items(3);
    return Vec3(glm::dvec3(xyz[0].number(), xyz[1].number(), xyz[2].number()) - origin);
}

/// Unit `v`, which came from `key`.
Vec3 direction(const Vec3& v, const JsonReader& in, const char* key)
{
    const glm::dvec3 d(v);
    const double length = std::sqrt(glm::dot(d, d));
    if (!(length > 1e-12)) in.fail(key, "gives no direction");
    return Vec3(d / length);
}

Camera readCamera(const JsonReader& in, const glm::dvec3& origin)
{
    in.allowOnly({"name", "eye", "target", "up", "verticalFovDegrees"});
    Camera camera;
    camera.name = textOr("view", in, "name");
    camera.position = placeOf(in["eye"], origin);
    camera.forward = direction(placeOf(in["target"], origin) - camera.position, in, "target");
    const Vec3 up = direction(in.has("up") ? vectorOf(in["up"]) : Vec3(0.0f, 1.0f, 0.0f), in, "up");
    const Vec3 upright = up - camera.forward * glm::dot(up, camera.forward);
    if (glm::length(upright) < 1e-4f) in.fail("up", "is parallel to the direction of view");
    camera.up = direction(upright, in, "up");
    camera.verticalFov = float(double(numberOr(45.0f, in, "verticalFovDegrees", 0.1, 179.0)) * kDegree);
    return camera;
}

Vec3 readIntensity(const JsonReader& in)
{
    const Vec3 color = in.has("color") ? vectorOf(in["color"]) : Vec3(1.0f);
    if (color.x < 0.0f || color.y < 0.0f || color.z < 0.0f) in.fail("color", "must not be negative");
    const Vec3 intensity = color * numberOr(1.0f, in, "intensity", 0.0, 1e12);
    if (!isFinite(intensity)) in.fail("intensity", "times color is not finite");
    return intensity;
}

void addLight(const JsonReader& in, const glm::dvec3& origin, View& view)
{
    const std::string type = in["type"].text();
    Light light;
    light.name = textOr("light " + std::to_string(view.lights->size()), in, "name");
    light.intensity = readIntensity(in);
    if (type == "directional") {
        in.allowOnly({"type", "name", "direction", "color", "intensity"});
        light.type = LightType::directional;
        light.direction = direction(vectorOf(in["direction"]), in, "direction");
    } else if (type == "spot") {
        in.allowOnly({"type", "name", "position", "target", "direction", "color", "intensity", "range", "innerConeAngleDegrees", "outerConeAngleDegrees"});
        light.type = LightType::spot;
        light.position = placeOf(in["position"], origin);
        if (in.has("target") == in.has("direction")) in.fail("target", "give either target or direction");
        light.direction =
            in.has("target") ? direction(placeOf(in["target"], origin) - light.position, in, "target") : direction(vectorOf(in["direction"]), in, "direction");
        light.range = numberOr(kInfinity, in, "range", 1e-12, 1e30);
        light.innerConeAngle = float(double(numberOr(0.0f, in, "innerConeAngleDegrees", 0.0, 89.0)) * kDegree);
        light.outerConeAngle = float(double(numberOr(45.0f, in, "outerConeAngleDegrees", 0.01, 89.0)) * kDegree);
        if (!(light.innerConeAngle <= light.outerConeAngle)) in.fail("innerConeAngleDegrees", "must not be larger than outerConeAngleDegrees");
    } else if (type == "point") {
        in.allowOnly({"type", "name", "position", "color", "intensity", "range"});
        const std::vector<Light> faces =
            splitPointLight(placeOf(in["position"], origin), light.intensity, numberOr(kInfinity, in, "range", 1e-12, 1e30), light.name);
        view.lights->insert(view.lights->end(), faces.begin(), faces.end());
        view.notes.push_back("point light \"" + light.name + "\" split into six faces of a cube");
        return;
    } else {
        in.fail("type", "must be directional, spot or point");
    }
    light.up = uprightFor(light.direction);
    view.lights->push_back(light);
}

/// What is changed, without the name.
MaterialChange readChange(const JsonReader& in)
{
    MaterialChange change;
    if (in.has("roughness")) change.roughness = numberOr(0.0f, in, "roughness", 0.0, 1.0);
    if (in.has("metallic")) change.metallic = numberOr(0.0f, in, "metallic", 0.0, 1.0);
    if (!in.has("baseColor")) return change;
    change.baseColor = vectorOf(in["baseColor"]);
    for (int c = 0; c < 3; ++c)
        if (!((*change.baseColor)[c] >= 0.0f && (*change.baseColor)[c] <= 1.0f)) in.fail("baseColor", "must be in [0, 1]");
    return change;
}

MaterialChange readMaterial(const JsonReader& in)
{
    in.allowOnly({"name", "roughness", "metallic", "baseColor"});
    MaterialChange change = readChange(in);
    change.name = in["name"].text();
    return change;
}

ViewObject readObject(const JsonReader& in)
{
    in.allowOnly({"scene", "animation", "material", "position", "yaw", "scale"});
    ViewObject object;
    object.scene = in["scene"].text();
    if (object.scene.empty()) in.fail("scene", "is empty");
    if (in.has("animation")) object.placement.animation = int(in["animation"].whole(-1, 1 << 20));
    if (in.has("material")) {
        in["material"].allowOnly({"roughness", "metallic", "baseColor"});
        object.material = readChange(in["material"]);
    }
    if (in.has("position")) {
        vectorOf(in["position"]);  // refuses what is none
        const auto xyz = in["position"].items();
        for (int c = 0; c < 3; ++c) object.placement.position[c] = xyz[std::size_t(c)].number();
    }
    if (in.has("yaw")) object.placement.yawDegrees = in["yaw"].number(-1e6, 1e6);
    if (in.has("scale")) object.placement.scale = in["scale"].number(1e-9, 1e9);
    return object;
}

/// What of each may have keys.
const KeyedNames kCameraNames = {"eye", "target", "up", "verticalFovDegrees"}, kObjectNames = {"position", "yaw", "scale"},
                 kLightNames = {"direction", "position", "target", "color", "intensity", "range", "innerConeAngleDegrees", "outerConeAngleDegrees"};

/// Calls visit(reader, names) of everything that may have keys.
template <class Visit>
void forEachKeyed(const JsonReader& in, const Visit& visit)
{
    if (in.has("camera")) visit(in["camera"], kCameraNames);
    if (in.has("lights"))
        for (const JsonReader& light : in["lights"].items()) visit(light, kLightNames);
    if (in.has("objects"))
        for (const JsonReader& object : in["objects"].items()) visit(object, kObjectNames);
}

}  // namespace

View parseView(const std::string& text, const std::string& file, const glm::dvec3& origin, double time)
{
    const JsonReader::Json json = parseJson(text, file);
    const JsonReader in(json, file);
    in.allowOnly({"scene", "camera", "lights", "materials", "objects"});

    View view;
    view.scene = textOr("", in, "scene");
    if (in.has("scene") && view.scene.empty()) in.fail("scene", "is empty");
    if (in.has("camera")) view.camera = readCamera(Moment(in["camera"], kCameraNames, time).reader(), origin);
    if (in.has("lights")) {
        if (!json["lights"].is_array() || json["lights"].empty()) in.fail("lights", "must be an array of at least one light");
        view.lights.emplace();
        for (const JsonReader& light : in["lights"].items()) addLight(Moment(light, kLightNames, time).reader(), origin, view);
    }
    if (in.has("materials"))
        for (const JsonReader& material : in["materials"].items()) view.materials.push_back(readMaterial(material));
    if (in.has("objects"))
        for (const JsonReader& object : in["objects"].items()) view.objects.push_back(readObject(Moment(object, kObjectNames, time).reader()));
    return view;
}

void changeMaterials(Scene& scene, const std::vector<MaterialChange>& changes, const std::string& place)
{
    for (const MaterialChange& change : changes) {
        bool found = false;
        for (Material& material : scene.materials) {
            if (material.name != change.name) continue;
            found = true;
            changeMaterial(material, change);
        }
        if (!found)
            throw InputError(place + ": materials", "the scene has no material \"" + change.name + "\"; it has " + joined(scene.materials, &Material::name));
    }
}

void changeMaterial(Material& material, const MaterialChange& change)
{
    // The texture holds roughness and metallic: the one that is not given keeps its factor alone.
    if (change.roughness || change.metallic) material.metallicRoughnessTexture = {};
    if (change.roughness) material.roughness = *change.roughness;
    if (change.metallic) material.metallic = *change.metallic;
    if (!change.baseColor) return;
    material.baseColor = Vec4(*change.baseColor, material.baseColor.a);
    if (!material.alphaMask) material.baseColorTexture = {};
}

ViewFile openViewFile(const std::string& path)
{
    const std::vector<unsigned char> bytes = readFile(path);
    ViewFile file{path, std::string(bytes.begin(), bytes.end()), {}};
    const JsonReader::Json json = parseJson(file.text, path);
    forEachKeyed(JsonReader(json, path), [&](const JsonReader& item, const KeyedNames& names) {
        const std::vector<double> times = keyTimesOf(item, names);
        file.keyTimes.insert(file.keyTimes.end(), times.begin(), times.end());
    });
    std::sort(file.keyTimes.begin(), file.keyTimes.end());
    file.keyTimes.erase(std::unique(file.keyTimes.begin(), file.keyTimes.end()), file.keyTimes.end());

    viewAt(file, 0.0);
    for (const double time : file.keyTimes) viewAt(file, time);
    return file;
}

View viewAt(const ViewFile& file, double time, const glm::dvec3& origin)
{
    return parseView(file.text, file.path, origin, time);
}

}  // namespace lrsm
