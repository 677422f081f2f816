#include "core/scene/gltf_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>

namespace lrsm::gltf {
namespace {

enum class Kind { object, array, string, boolean, integer, number, numbers, index, oneOf };

/// One property: its path ("*" any element of an array, "%" any member of an object) and what it may hold.
struct Rule {
    std::string_view path;
    Kind kind;
    bool required = false;
    std::string_view detail = {};  ///< index: the array it points into; oneOf: the values; numbers: how many
    double min = -1e300, max = 1e300;
};

constexpr double kMaxInteger = 9007199254740992.0;  // 2^53: exact in a double
constexpr double kHalfPi = 1.5707963267948966;
constexpr bool kRequired = true, kOptional = false;

constexpr auto kRules = std::to_array<Rule>({
    {"asset", Kind::object, kRequired},
    {"asset.version", Kind::string, kRequired},
    {"asset.minVersion", Kind::string},
    {"extensionsUsed.*", Kind::string},
    {"extensionsRequired.*", Kind::string},

    {"buffers.*.byteLength", Kind::integer, kRequired, {}, 1, kMaxInteger},
    {"buffers.*.uri", Kind::string},
    {"bufferViews.*.buffer", Kind::index, kRequired, "buffers"},
    {"bufferViews.*.byteOffset", Kind::integer, kOptional, {}, 0, kMaxInteger},
    {"bufferViews.*.byteLength", Kind::integer, kRequired, {}, 1, kMaxInteger},
    {"bufferViews.*.byteStride", Kind::integer, kOptional, {}, 4, 252},

    {"accessors.*.bufferView", Kind::index, kOptional, "bufferViews"},
    {"accessors.*.byteOffset", Kind::integer, kOptional, {}, 0, kMaxInteger},
    {"accessors.*.componentType", Kind::oneOf, kRequired, "5120 5121 5122 5123 5125 5126"},
    {"accessors.*.normalized", Kind::boolean},
    {"accessors.*.count", Kind::integer, kRequired, {}, 1, 4294967295.0},
    {"accessors.*.type", Kind::oneOf, kRequired, "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"},
    {"accessors.*.sparse.count", Kind::integer, kRequired, {}, 1, 2147483647.0},
    {"accessors.*.sparse.indices", Kind::object, kRequired},
    {"accessors.*.sparse.indices.bufferView", Kind::index, kRequired, "bufferViews"},
    {"accessors.*.sparse.indices.byteOffset", Kind::integer, kOptional, {}, 0, 2147483647.0},
    {"accessors.*.sparse.indices.componentType", Kind::oneOf, kRequired, "5121 5123 5125"},
    {"accessors.*.sparse.values", Kind::object, kRequired},
    {"accessors.*.sparse.values.bufferView", Kind::index, kRequired, "bufferViews"},
    {"accessors.*.sparse.values.byteOffset", Kind::integer, kOptional, {}, 0, 2147483647.0},

    {"meshes.*.name", Kind::string},
    {"meshes.*.primitives", Kind::array, kRequired},
    {"meshes.*.primitives.*.attributes", Kind::object, kRequired},
    {"meshes.*.primitives.*.attributes.%", Kind::index, kRequired, "accessors"},
    {"meshes.*.primitives.*.indices", Kind::index, kOptional, "accessors"},
    {"meshes.*.primitives.*.material", Kind::index, kOptional, "materials"},
    {"meshes.*.primitives.*.mode", Kind::integer, kOptional, {}, 0, 6},
    {"meshes.*.primitives.*.targets.*.%", Kind::index, kRequired, "accessors"},
    {"meshes.*.weights", Kind::numbers},

    {"nodes.*.name", Kind::string},
    {"nodes.*.children.*", Kind::index, kRequired, "nodes"},
    {"nodes.*.mesh", Kind::index, kOptional, "meshes"},
    {"nodes.*.skin", Kind::index, kOptional, "skins"},
    {"nodes.*.camera", Kind::index, kOptional, "cameras"},
    {"nodes.*.matrix", Kind::numbers, kOptional, "16"},
    {"nodes.*.translation", Kind::numbers, kOptional, "3"},
    {"nodes.*.rotation", Kind::numbers, kOptional, "4"},
    {"nodes.*.scale", Kind::numbers, kOptional, "3"},
    {"nodes.*.weights", Kind::numbers},
    {"nodes.*.extensions.KHR_lights_punctual.light", Kind::index, kRequired, "extensions.KHR_lights_punctual.lights"},
    {"scenes.*.name", Kind::string},
    {"scenes.*.nodes.*", Kind::index, kRequired, "nodes"},
    {"scene", Kind::index, kOptional, "scenes"},

    {"skins.*.joints", Kind::array, kRequired},
    {"skins.*.joints.*", Kind::index, kRequired, "nodes"},
    {"skins.*.inverseBindMatrices", Kind::index, kOptional, "accessors"},
    {"skins.*.skeleton", Kind::index, kOptional, "nodes"},

    {"animations.*.name", Kind::string},
    {"animations.*.channels", Kind::array, kRequired},
    {"animations.*.channels.*.sampler", Kind::integer, kRequired, {}, 0, 2147483647.0},
    {"animations.*.channels.*.target", Kind::object, kRequired},
    {"animations.*.channels.*.target.node", Kind::index, kOptional, "nodes"},
    {"animations.*.channels.*.target.path", Kind::string, kRequired},
    {"animations.*.samplers", Kind::array, kRequired},
    {"animations.*.samplers.*.input", Kind::index, kRequired, "accessors"},
    {"animations.*.samplers.*.output", Kind::index, kRequired, "accessors"},
    {"animations.*.samplers.*.interpolation", Kind::string},

    {"cameras.*.name", Kind::string},
    {"cameras.*.type", Kind::oneOf, kRequired, "perspective orthographic"},
    {"cameras.*.perspective.yfov", Kind::number, kRequired, {}, 1e-4, 3.1415},
    {"cameras.*.perspective.znear", Kind::number, kRequired, {}, 1e-30, 1e30},
    {"cameras.*.perspective.aspectRatio", Kind::number, kOptional, {}, 1e-6, 1e6},
    {"cameras.*.orthographic.xmag", Kind::number, kRequired},
    {"cameras.*.orthographic.ymag", Kind::number, kRequired},
    {"cameras.*.orthographic.znear", Kind::number, kRequired, {}, 0, 1e30},

    {"images.*.name", Kind::string},
    {"images.*.uri", Kind::string},
    {"images.*.bufferView", Kind::index, kOptional, "bufferViews"},
    {"textures.*.name", Kind::string},
    {"textures.*.source", Kind::index, kOptional, "images"},
    {"textures.*.sampler", Kind::index, kOptional, "samplers"},
    {"samplers.*.magFilter", Kind::integer},
    {"samplers.*.minFilter", Kind::integer},
    {"samplers.*.wrapS", Kind::oneOf, kOptional, "33071 33648 10497"},
    {"samplers.*.wrapT", Kind::oneOf, kOptional, "33071 33648 10497"},

    {"materials.*.name", Kind::string},
    {"materials.*.pbrMetallicRoughness.baseColorFactor", Kind::numbers, kOptional, "4", 0, 1},
    {"materials.*.pbrMetallicRoughness.metallicFactor", Kind::number, kOptional, {}, 0, 1},
    {"materials.*.pbrMetallicRoughness.roughnessFactor", Kind::number, kOptional, {}, 0, 1},
    {"materials.*.normalTexture.scale", Kind::number, kOptional, {}, -1e6, 1e6},
    {"materials.*.emissiveFactor", Kind::numbers, kOptional, "3"},
    {"materials.*.alphaMode", Kind::string},
    {"materials.*.alphaCutoff", Kind::number, kOptional, {}, 0, 1e6},
    {"materials.*.doubleSided", Kind::boolean},

    {"extensions.KHR_lights_punctual.lights", Kind::array, kRequired},
    {"extensions.KHR_lights_punctual.lights.*.name", Kind::string},
    {"extensions.KHR_lights_punctual.lights.*.type", Kind::oneOf, kRequired, "directional point spot"},
    {"extensions.KHR_lights_punctual.lights.*.color", Kind::numbers, kOptional, "3", 0, 1e6},
    {"extensions.KHR_lights_punctual.lights.*.intensity", Kind::number, kOptional, {}, 0, 1e12},
    {"extensions.KHR_lights_punctual.lights.*.range", Kind::number, kOptional, {}, 1e-12, 1e30},
    {"extensions.KHR_lights_punctual.lights.*.spot.innerConeAngle", Kind::number, kOptional, {}, 0, kHalfPi},
    {"extensions.KHR_lights_punctual.lights.*.spot.outerConeAngle", Kind::number, kOptional, {}, 1e-4, kHalfPi + 1e-6},
});

/// Inside each texture reference of a material.
constexpr auto kTextureInfos = std::to_array<std::string_view>({
    "materials.*.pbrMetallicRoughness.baseColorTexture",
    "materials.*.pbrMetallicRoughness.metallicRoughnessTexture",
    "materials.*.normalTexture",
    "materials.*.occlusionTexture",
    "materials.*.emissiveTexture",
});
constexpr auto kTextureInfoRules = std::to_array<Rule>({
    {".index", Kind::index, kRequired, "textures"},
    {".texCoord", Kind::integer, kOptional, {}, 0, 1000},
    {".extensions.KHR_texture_transform.offset", Kind::numbers, kOptional, "2", -1e6, 1e6},
    {".extensions.KHR_texture_transform.scale", Kind::numbers, kOptional, "2", -1e6, 1e6},
    {".extensions.KHR_texture_transform.rotation", Kind::number, kOptional, {}, -1e6, 1e6},
    {".extensions.KHR_texture_transform.texCoord", Kind::integer, kOptional, {}, 0, 1000},
});

/// Arrays of objects at the top of the file: a wrong type there is an error even where nothing inside is read.
constexpr auto kCollections = std::to_array<std::string_view>(
    {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials", "meshes", "nodes", "samplers", "scenes", "skins", "textures"});

class Checker {
  public:
    explicit Checker(const Document& document) : document_(document) {}

    void check(const Rule& rule) const { visit(document_.json, rule.path, "", rule); }

  private:
    /// Follows the pattern from `node`; a missing member on the way ends it, a missing last member matters if required.
    void visit(const Json& node, std::string_view pattern, const std::string& path, const Rule& rule) const
    {
        if (pattern.empty()) return checkValue(node, path, rule);
        const std::size_t dot = pattern.find('.');
        const std::string name(pattern.substr(0, dot));
        const std::string_view rest = dot == std::string_view::npos ? std::string_view{} : pattern.substr(dot + 1);
        const auto member = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };

        if (name == "*") {
            if (!node.is_array()) document_.fail(path, "must be an array");
            for (std::size_t i = 0; i < node.size(); ++i) visit(node[i], rest, at(path, i), rule);
        } else if (!node.is_object()) {
            document_.fail(path.empty() ? "JSON" : path, "must be an object");
        } else if (name == "%") {
            for (const auto& item : node.items()) visit(item.value(), rest, member(item.key()), rule);
        } else if (const auto found = node.find(name); found != node.end()) {
            visit(*found, rest, member(name), rule);
        } else if (rest.empty() && rule.required) {
            document_.fail(member(name), "is missing");
        }
    }

    void checkNumber(const Json& value, const std::string& path, const Rule& rule) const
    {
        if (!value.is_number()) document_.fail(path, "must be a number");
        const double number = value.get<double>();
        if (!std::isfinite(number)) document_.fail(path, "must be finite");
        if (number < rule.min || number > rule.max) {
            std::ostringstream why;
            why << number << " is out of range [" << rule.min << ", " << rule.max << "]";
            document_.fail(path, why.str());
        }
    }

    void checkIndex(const Json& value, const std::string& path, const Rule& rule) const
    {
        if (!value.is_number_integer()) document_.fail(path, "must be an index");
        const Json* target = &document_.json;
        for (std::string_view rest = rule.detail; target && !rest.empty();) {
            const std::string name(rest.substr(0, rest.find('.')));
            rest.remove_prefix(std::min(rest.size(), name.size() + 1));
            target = target->is_object() && target->contains(name) ? &(*target)[name] : nullptr;
        }
        const std::size_t count = target && target->is_array() ? target->size() : 0;
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= count)
            document_.fail(path, value.dump() + " points to nothing: there are " + std::to_string(count) + " " + std::string(rule.detail));
    }

    void checkOneOf(const Json& value, const std::string& path, const Rule& rule) const
    {
        const std::string text = value.is_string() ? value.get<std::string>() : value.is_number_integer() ? value.dump() : "";
        std::istringstream values{std::string(rule.detail)};
        for (std::string allowed; values >> allowed;)
            if (text == allowed) return;
        document_.fail(path, "must be one of " + std::string(rule.detail));
    }

    void checkValue(const Json& value, const std::string& path, const Rule& rule) const
    {
        switch (rule.kind) {
        case Kind::object:
            if (!value.is_object()) document_.fail(path, "must be an object");
            return;
        case Kind::array:
            if (!value.is_array()) document_.fail(path, "must be an array");
            return;
        case Kind::string:
            if (!value.is_string()) document_.fail(path, "must be a string");
            return;
        case Kind::boolean:
            if (!value.is_boolean()) document_.fail(path, "must be true or false");
            return;
        case Kind::integer:
            if (!value.is_number_integer()) document_.fail(path, "must be an integer");
            return checkNumber(value, path, rule);
        case Kind::number: return checkNumber(value, path, rule);
        case Kind::numbers:
            if (!value.is_array() || (!rule.detail.empty() && std::to_string(value.size()) != rule.detail))
                document_.fail(path, "must be an array of " + std::string(rule.detail) + (rule.detail.empty() ? "" : " ") + "numbers");
            for (std::size_t i = 0; i < value.size(); ++i) checkNumber(value[i], at(path, i), rule);
            return;
        case Kind::index: return checkIndex(value, path, rule);
        case Kind::oneOf: return checkOneOf(value, path, rule);
        }
    }

    const Document& document_;
};

}  // namespace

std::string at(const std::string& path, std::size_t index)
{
    return path + "[" + std::to_string(index) + "]";
}

void checkSchema(const Document& document)
{
    const Checker checker(document);
    if (!document.json.is_object()) document.fail("JSON", "must be an object");
    for (const std::string_view collection : kCollections) checker.check({std::string(collection) + ".*", Kind::object});
    for (const Rule& rule : kRules) checker.check(rule);
    for (const std::string_view info : kTextureInfos) {
        for (const Rule& inner : kTextureInfoRules) {
            const std::string path = std::string(info) + std::string(inner.path);
            Rule rule = inner;
            rule.path = path;
            checker.check(rule);
        }
    }
}

}  // namespace lrsm::gltf
