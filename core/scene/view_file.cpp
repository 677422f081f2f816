#include "core/scene/view_file.h"

#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/scene/defaults.h"
#include "core/scene/light.h"

#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string_view>

namespace lrsm {
namespace {

using Json = nlohmann::json;

constexpr double kDegree = 0.017453292519943295;

/// One JSON object of the file; every access checks, and says where it failed.
class Reader {
  public:
    Reader(const Json& json, std::string file, std::string path) : json_(json), file_(std::move(file)), path_(std::move(path))
    {
        if (!json_.is_object()) fail("", "must be an object");
    }

    [[noreturn]] void fail(const std::string& key, const std::string& why) const
    {
        const std::string full = path_.empty() ? key : key.empty() ? path_ : path_ + "." + key;
        throw InputError(file_ + (full.empty() ? "" : ": " + full), why);
    }

    void allowOnly(std::initializer_list<std::string_view> keys) const
    {
        for (const auto& item : json_.items()) {
            if (std::find(keys.begin(), keys.end(), item.key()) != keys.end()) continue;
            std::string known;
            for (const std::string_view key : keys) known += (known.empty() ? "" : ", ") + std::string(key);
            fail("", "unknown key " + Json(item.key()).dump() + "; known: " + known);
        }
    }

    bool has(const char* key) const { return json_.contains(key); }

    const Json& child(const char* key) const
    {
        if (!has(key)) fail(key, "is missing");
        return json_[key];
    }

    std::string text(const char* key) const
    {
        if (!child(key).is_string()) fail(key, "must be a string");
        return json_[key].get<std::string>();
    }

    /// A number within [min, max], or the fallback if the key is absent.
    float number(const char* key, float fallback, double min, double max) const
    {
        if (!has(key)) return fallback;
        if (!json_[key].is_number()) fail(key, "must be a number");
        const double value = json_[key].get<double>();
        if (!(value >= min && value <= max)) {
            const auto plain = [](double v) { return Json(v).dump(); };
            fail(key, plain(value) + " is out of range [" + plain(min) + ", " + plain(max) + "]");
        }
        return float(value);
    }

    Vec3 vector(const char* key) const
    {
        const Json& value = child(key);
        if (!value.is_array() || value.size() != 3) fail(key, "must be an array of 3 numbers");
        Vec3 v;
        for (int c = 0; c < 3; ++c) {
            if (!value[std::size_t(c)].is_number()) fail(key, "must be an array of 3 numbers");
            v[c] = value[std::size_t(c)].get<float>();
        }
        if (!isFinite(v) || glm::length(v) > 1e15f) fail(key, "is not finite, or larger than 1e15");
        return v;
    }

    Vec3 direction(const char* key, const Vec3& v) const
    {
        const glm::dvec3 d(v);
        const double length = std::sqrt(glm::dot(d, d));
        if (!(length > 1e-12)) fail(key, "gives no direction");
        return Vec3(d / length);
    }

  private:
    const Json& json_;
    std::string file_, path_;
};

Camera readCamera(const Reader& reader)
{
    reader.allowOnly({"name", "eye", "target", "up", "verticalFovDegrees"});
    Camera camera;
    camera.name = reader.has("name") ? reader.text("name") : "view";
    camera.position = reader.vector("eye");
    camera.forward = reader.direction("target", reader.vector("target") - camera.position);
    const Vec3 up = reader.direction("up", reader.has("up") ? reader.vector("up") : Vec3(0.0f, 1.0f, 0.0f));
    const Vec3 upright = up - camera.forward * glm::dot(up, camera.forward);
    if (glm::length(upright) < 1e-4f) reader.fail("up", "is parallel to the direction of view");
    camera.up = reader.direction("up", upright);
    camera.verticalFov = float(double(reader.number("verticalFovDegrees", 45.0f, 0.1, 179.0)) * kDegree);
    return camera;
}

Vec3 readIntensity(const Reader& reader)
{
    const Vec3 color = reader.has("color") ? reader.vector("color") : Vec3(1.0f);
    if (color.x < 0.0f || color.y < 0.0f || color.z < 0.0f) reader.fail("color", "must not be negative");
    const Vec3 intensity = color * reader.number("intensity", 1.0f, 0.0, 1e12);
    if (!isFinite(intensity)) reader.fail("intensity", "times color is not finite");
    return intensity;
}

void addLight(const Reader& reader, View& view)
{
    const std::string type = reader.text("type");
    Light light;
    light.name = reader.has("name") ? reader.text("name") : "light " + std::to_string(view.lights->size());
    light.intensity = readIntensity(reader);
    if (type == "directional") {
        reader.allowOnly({"type", "name", "direction", "color", "intensity"});
        light.type = LightType::directional;
        light.direction = reader.direction("direction", reader.vector("direction"));
    } else if (type == "spot") {
        reader.allowOnly({"type", "name", "position", "target", "direction", "color", "intensity", "range", "innerConeAngleDegrees", "outerConeAngleDegrees"});
        light.type = LightType::spot;
        light.position = reader.vector("position");
        if (reader.has("target") == reader.has("direction")) reader.fail("target", "give either target or direction");
        light.direction = reader.has("target") ? reader.direction("target", reader.vector("target") - light.position)
                                               : reader.direction("direction", reader.vector("direction"));
        light.range = reader.number("range", kInfinity, 1e-12, 1e30);
        light.innerConeAngle = float(double(reader.number("innerConeAngleDegrees", 0.0f, 0.0, 89.0)) * kDegree);
        light.outerConeAngle = float(double(reader.number("outerConeAngleDegrees", 45.0f, 0.01, 89.0)) * kDegree);
        if (!(light.innerConeAngle < light.outerConeAngle)) reader.fail("innerConeAngleDegrees", "must be smaller than outerConeAngleDegrees");
    } else if (type == "point") {
        reader.allowOnly({"type", "name", "position", "color", "intensity", "range"});
        const std::vector<Light> faces =
            splitPointLight(reader.vector("position"), light.intensity, reader.number("range", kInfinity, 1e-12, 1e30), light.name);
        view.lights->insert(view.lights->end(), faces.begin(), faces.end());
        view.notes.push_back("point light \"" + light.name + "\" split into six faces of a cube");
        return;
    } else {
        reader.fail("type", "must be directional, spot or point");
    }
    light.up = uprightFor(light.direction);
    view.lights->push_back(light);
}

Json parse(const std::string& text, const std::string& file)
{
    try {
        return Json::parse(text);
    } catch (const Json::exception& error) {
        std::string why = error.what();
        if (const std::size_t end = why.find("] "); end != std::string::npos) why.erase(0, end + 2);
        throw InputError(file + ": JSON", why);
    }
}

}  // namespace

View parseView(const std::string& text, const std::string& file)
{
    const Json json = parse(text, file);
    const Reader root(json, file, "");
    root.allowOnly({"scene", "camera", "lights"});

    View view;
    if (root.has("scene")) view.scene = root.text("scene");
    if (root.has("scene") && view.scene.empty()) root.fail("scene", "is empty");
    if (root.has("camera")) view.camera = readCamera(Reader(json["camera"], file, "camera"));
    if (root.has("lights")) {
        if (!json["lights"].is_array() || json["lights"].empty()) root.fail("lights", "must be an array of at least one light");
        view.lights.emplace();
        for (std::size_t i = 0; i < json["lights"].size(); ++i) addLight(Reader(json["lights"][i], file, "lights[" + std::to_string(i) + "]"), view);
    }
    return view;
}

View readViewFile(const std::string& path)
{
    const std::vector<unsigned char> bytes = readFile(path);
    return parseView(std::string(bytes.begin(), bytes.end()), path);
}

}  // namespace lrsm
