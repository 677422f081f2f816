#include "core/scene/gltf_schema.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

namespace lrsm::gltf {
namespace {

using Json = JsonReader::Json;

enum class Kind { object, array, string, boolean, integer, number, numbers, index, oneOf };

/// What a property may hold: numbers within [min, max]; an index into `detail`, a JSON pointer; one of the words of `detail`; `detail` numbers.
struct Allowed {
    constexpr Allowed() = default;
    constexpr Allowed(double least, double most) : min(least), max(most) {}
    constexpr Allowed(const char* what) : detail(what) {}
    constexpr Allowed(const char* what, double least, double most) : detail(what), min(least), max(most) {}
    std::string_view detail;
    double min = -1e300, max = 1e300;
};

/// One property: its path ("*" any element of an array, "%" any member of an object, "!" at the end: required).
struct Rule {
    std::string_view path;
    Kind kind;
    Allowed allowed = {};
};

constexpr double kMaxInteger = 9007199254740992.0;  // 2^53: exact in a double
constexpr double kHalfPi = 1.5707963267948966;

constexpr auto kRules = std::to_array<Rule>({
    {"asset!", Kind::object},
    {"asset.version!", Kind::string},
    {"asset.minVersion", Kind::string},
    {"extensionsUsed.*", Kind::string},
    {"extensionsRequired.*", Kind::string},

    {"buffers.*.byteLength!", Kind::integer, {1, kMaxInteger}},
    {"buffers.*.uri", Kind::string},
    {"bufferViews.*.buffer!", Kind::index, "buffers"},
    {"bufferViews.*.byteOffset", Kind::integer, {0, kMaxInteger}},
    {"bufferViews.*.byteLength!", Kind::integer, {1, kMaxInteger}},
    {"bufferViews.*.byteStride", Kind::integer, {1, 2147483647.0}},
    {"bufferViews.*.extensions.EXT_meshopt_compression.buffer!", Kind::index, "buffers"},
    {"bufferViews.*.extensions.EXT_meshopt_compression.byteOffset", Kind::integer, {0, kMaxInteger}},
    {"bufferViews.*.extensions.EXT_meshopt_compression.byteLength!", Kind::integer, {1, kMaxInteger}},
    {"bufferViews.*.extensions.EXT_meshopt_compression.byteStride!", Kind::integer, {1, 256}},
    {"bufferViews.*.extensions.EXT_meshopt_compression.count!", Kind::integer, {1, 4294967295.0}},
    {"bufferViews.*.extensions.EXT_meshopt_compression.mode!", Kind::oneOf, "ATTRIBUTES TRIANGLES INDICES"},
    {"bufferViews.*.extensions.EXT_meshopt_compression.filter", Kind::oneOf, "NONE OCTAHEDRAL QUATERNION EXPONENTIAL"},

    {"accessors.*.bufferView", Kind::index, "bufferViews"},
    {"accessors.*.byteOffset", Kind::integer, {0, kMaxInteger}},
    {"accessors.*.componentType!", Kind::oneOf, "5120 5121 5122 5123 5125 5126"},
    {"accessors.*.normalized", Kind::boolean},
    {"accessors.*.count!", Kind::integer, {1, 4294967295.0}},
    {"accessors.*.type!", Kind::oneOf, "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"},
    {"accessors.*.sparse.count!", Kind::integer, {1, 2147483647.0}},
    {"accessors.*.sparse.indices!", Kind::object},
    {"accessors.*.sparse.indices.bufferView!", Kind::index, "bufferViews"},
    {"accessors.*.sparse.indices.byteOffset", Kind::integer, {0, 2147483647.0}},
    {"accessors.*.sparse.indices.componentType!", Kind::oneOf, "5121 5123 5125"},
    {"accessors.*.sparse.values!", Kind::object},
    {"accessors.*.sparse.values.bufferView!", Kind::index, "bufferViews"},
    {"accessors.*.sparse.values.byteOffset", Kind::integer, {0, 2147483647.0}},

    {"meshes.*.primitives!", Kind::array},
    {"meshes.*.primitives.*.attributes!", Kind::object},
    {"meshes.*.primitives.*.attributes.%", Kind::index, "accessors"},
    {"meshes.*.primitives.*.indices", Kind::index, "accessors"},
    {"meshes.*.primitives.*.material", Kind::index, "materials"},
    {"meshes.*.primitives.*.mode", Kind::integer, {0, 6}},
    {"meshes.*.primitives.*.targets.*.%", Kind::index, "accessors"},
    {"meshes.*.primitives.*.extensions.KHR_draco_mesh_compression.bufferView!", Kind::index, "bufferViews"},
    {"meshes.*.primitives.*.extensions.KHR_draco_mesh_compression.attributes!", Kind::object},
    {"meshes.*.primitives.*.extensions.KHR_draco_mesh_compression.attributes.%", Kind::integer, {0, 2147483647.0}},
    {"meshes.*.weights", Kind::numbers},

    {"nodes.*.children.*", Kind::index, "nodes"},
    {"nodes.*.mesh", Kind::index, "meshes"},
    {"nodes.*.skin", Kind::index, "skins"},
    {"nodes.*.camera", Kind::index, "cameras"},
    {"nodes.*.matrix", Kind::numbers, "16"},
    {"nodes.*.translation", Kind::numbers, "3"},
    {"nodes.*.rotation", Kind::numbers, "4"},
    {"nodes.*.scale", Kind::numbers, "3"},
    {"nodes.*.weights", Kind::numbers},
    {"nodes.*.extensions.KHR_lights_punctual.light!", Kind::index, "extensions/KHR_lights_punctual/lights"},
    {"nodes.*.extensions.EXT_mesh_gpu_instancing.attributes!", Kind::object},
    {"nodes.*.extensions.EXT_mesh_gpu_instancing.attributes.%", Kind::index, "accessors"},
    {"scenes.*.nodes.*", Kind::index, "nodes"},
    {"scene", Kind::index, "scenes"},

    {"skins.*.joints!", Kind::array},
    {"skins.*.joints.*", Kind::index, "nodes"},
    {"skins.*.inverseBindMatrices", Kind::index, "accessors"},
    {"skins.*.skeleton", Kind::index, "nodes"},

    {"animations.*.channels!", Kind::array},
    {"animations.*.channels.*.sampler!", Kind::integer, {0, 2147483647.0}},
    {"animations.*.channels.*.target!", Kind::object},
    {"animations.*.channels.*.target.node", Kind::index, "nodes"},
    {"animations.*.channels.*.target.path!", Kind::string},
    {"animations.*.samplers!", Kind::array},
    {"animations.*.samplers.*.input!", Kind::index, "accessors"},
    {"animations.*.samplers.*.output!", Kind::index, "accessors"},
    {"animations.*.samplers.*.interpolation", Kind::string},

    {"cameras.*.type!", Kind::oneOf, "perspective orthographic"},
    {"cameras.*.perspective.yfov!", Kind::number, {1e-4, 3.1415}},
    {"cameras.*.perspective.znear!", Kind::number, {1e-30, 1e30}},
    {"cameras.*.perspective.aspectRatio", Kind::number, {1e-6, 1e6}},
    {"cameras.*.orthographic.xmag!", Kind::number},
    {"cameras.*.orthographic.ymag!", Kind::number},
    {"cameras.*.orthographic.znear!", Kind::number, {0, 1e30}},

    {"images.*.uri", Kind::string},
    {"images.*.bufferView", Kind::index, "bufferViews"},
    {"textures.*.source", Kind::index, "images"},
    {"textures.*.extensions.EXT_texture_webp.source!", Kind::index, "images"},
    {"textures.*.sampler", Kind::index, "samplers"},
    {"samplers.*.magFilter", Kind::integer, {-kMaxInteger, kMaxInteger}},
    {"samplers.*.minFilter", Kind::integer, {-kMaxInteger, kMaxInteger}},
    {"samplers.*.wrapS", Kind::oneOf, "33071 33648 10497"},
    {"samplers.*.wrapT", Kind::oneOf, "33071 33648 10497"},

    {"materials.*.pbrMetallicRoughness.baseColorFactor", Kind::numbers, {"4", 0, 1}},
    {"materials.*.pbrMetallicRoughness.metallicFactor", Kind::number, {0, 1}},
    {"materials.*.pbrMetallicRoughness.roughnessFactor", Kind::number, {0, 1}},
    {"materials.*.extensions.KHR_materials_pbrSpecularGlossiness.diffuseFactor", Kind::numbers, {"4", 0, 1}},
    {"materials.*.normalTexture.scale", Kind::number, {-1e6, 1e6}},
    {"materials.*.emissiveFactor", Kind::numbers, "3"},
    {"materials.*.alphaMode", Kind::string},
    {"materials.*.alphaCutoff", Kind::number, {0, 1e6}},
    {"materials.*.doubleSided", Kind::boolean},

    {"extensions.KHR_lights_punctual.lights!", Kind::array},
    {"extensions.KHR_lights_punctual.lights.*.name", Kind::string},
    {"extensions.KHR_lights_punctual.lights.*.type!", Kind::oneOf, "directional point spot"},
    {"extensions.KHR_lights_punctual.lights.*.color", Kind::numbers, {"3", 0, 1e6}},
    {"extensions.KHR_lights_punctual.lights.*.intensity", Kind::number, {0, 1e12}},
    {"extensions.KHR_lights_punctual.lights.*.range", Kind::number, {1e-12, 1e30}},
    {"extensions.KHR_lights_punctual.lights.*.spot.innerConeAngle", Kind::number, {0, kHalfPi + 1e-6}},
    {"extensions.KHR_lights_punctual.lights.*.spot.outerConeAngle", Kind::number, {1e-4, kHalfPi + 1e-6}},
});

/// Inside each texture reference of a material.
constexpr auto kTextureInfos = std::to_array<std::string_view>({
    "materials.*.pbrMetallicRoughness.baseColorTexture",
    "materials.*.pbrMetallicRoughness.metallicRoughnessTexture",
    "materials.*.extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture",
    "materials.*.normalTexture",
    "materials.*.occlusionTexture",
    "materials.*.emissiveTexture",
});
constexpr auto kTextureInfoRules = std::to_array<Rule>({
    {".index!", Kind::index, "textures"},
    {".texCoord", Kind::integer, {0, 1000}},
    {".extensions.KHR_texture_transform.offset", Kind::numbers, {"2", -1e6, 1e6}},
    {".extensions.KHR_texture_transform.scale", Kind::numbers, {"2", -1e6, 1e6}},
    {".extensions.KHR_texture_transform.rotation", Kind::number, {-1e6, 1e6}},
    {".extensions.KHR_texture_transform.texCoord", Kind::integer, {0, 1000}},
});

/// Arrays of objects at the top of the file: a wrong type there is an error even where nothing inside is read.
constexpr auto kCollections = std::to_array<std::string_view>(
    {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials", "meshes", "nodes", "samplers", "scenes", "skins", "textures"});

class Checker {
  public:
    explicit Checker(const JsonReader& root) : root_(root) {}

    void check(const Rule& rule) const { visit(root_, rule.path.substr(0, rule.path.find('!')), rule); }

  private:
    /// Follows the pattern; a missing member on the way ends it, a missing last member matters if required.
    void visit(const JsonReader& in, std::string_view pattern, const Rule& rule) const
    {
        if (pattern.empty()) return checkValue(in, rule);
        const std::size_t dot = std::min(pattern.find('.'), pattern.size());
        const std::string name(pattern.substr(0, dot));
        const std::string_view rest = pattern.substr(std::min(dot + 1, pattern.size()));
        if (name == "*")
            for (const JsonReader& item : arrayItems(in)) visit(item, rest, rule);
        else if (name == "%")
            for (const auto& [key, value] : in.members()) visit(value, rest, rule);
        else if (in.has(name) || (rest.empty() && rule.path.ends_with('!')))
            visit(in[name], rest, rule);
    }

    static std::vector<JsonReader> arrayItems(const JsonReader& in)
    {
        if (!in.json().is_array()) in.fail("must be an array");
        return in.items();
    }

    void checkIndex(const JsonReader& in, const Rule& rule) const
    {
        const Json& index = in.json();
        const Json::json_pointer target("/" + std::string(rule.allowed.detail));
        const std::size_t count = root_.json().contains(target) && root_.json().at(target).is_array() ? root_.json().at(target).size() : 0;
        if (!index.is_number_integer()) in.fail("must be an index");
        if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= count)
            in.fail(index.dump() + " points to nothing: there are " + std::to_string(count) + " " + std::string(rule.allowed.detail));
    }

    static void checkOneOf(const JsonReader& in, const Rule& rule)
    {
        const Json& value = in.json();
        const std::string text = value.is_string() ? value.get<std::string>() : value.is_number_integer() ? value.dump() : "";
        std::istringstream values{std::string(rule.allowed.detail)};
        for (std::string allowed; values >> allowed;)
            if (text == allowed) return;
        in.fail("must be one of " + std::string(rule.allowed.detail));
    }

    static void checkNumbers(const JsonReader& in, const Rule& rule)
    {
        if (!in.json().is_array() || (!rule.allowed.detail.empty() && std::to_string(in.json().size()) != rule.allowed.detail))
            in.fail("must be an array of " + std::string(rule.allowed.detail) + (rule.allowed.detail.empty() ? "" : " ") + "numbers");
        for (const JsonReader& item : in.items()) item.number(rule.allowed.min, rule.allowed.max);
    }

    void checkValue(const JsonReader& in, const Rule& rule) const
    {
        switch (rule.kind) {
        case Kind::object: in.object(); return;
        case Kind::array: arrayItems(in); return;
        case Kind::string: in.text(); return;
        case Kind::boolean: in.flag(); return;
        case Kind::integer: in.whole(std::int64_t(rule.allowed.min), std::int64_t(rule.allowed.max)); return;
        case Kind::number: in.number(rule.allowed.min, rule.allowed.max); return;
        case Kind::numbers: return checkNumbers(in, rule);
        case Kind::index: return checkIndex(in, rule);
        case Kind::oneOf: return checkOneOf(in, rule);
        }
    }

    const JsonReader& root_;
};

}  // namespace

void checkSchema(const JsonReader& root)
{
    const Checker checker(root);
    for (const std::string_view collection : kCollections) {
        const std::string member = std::string(collection) + ".*", name = member + ".name";
        checker.check({member, Kind::object});
        checker.check({name, Kind::string});
    }
    for (const Rule& rule : kRules) checker.check(rule);
    for (const std::string_view info : kTextureInfos) {
        for (const Rule& inner : kTextureInfoRules) {
            const std::string path = std::string(info) + std::string(inner.path);
            checker.check({path, inner.kind, inner.allowed});
        }
    }
}

}  // namespace lrsm::gltf
