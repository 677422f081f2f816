#include "core/scene/gltf_mesh.h"

#include "core/scene/gltf_accessor.h"

#include <optional>

namespace lrsm::gltf {
namespace {

constexpr std::string_view kFloat3 = "VEC3 f";
constexpr std::string_view kUv = "VEC2 f nu8 nu16";
constexpr std::string_view kColor = "VEC3 VEC4 f nu8 nu16";
// KHR_mesh_quantization's tables.
constexpr std::string_view kQuantizedPosition = "VEC3 f s8 ns8 u8 nu8 s16 ns16 u16 nu16";
constexpr std::string_view kQuantizedNormal = "VEC3 f ns8 ns16";
constexpr std::string_view kQuantizedTangent = "VEC4 f ns8 ns16";
constexpr std::string_view kQuantizedUv = "VEC2 f s8 ns8 u8 nu8 s16 ns16 u16 nu16";

/// One primitive's attributes by name, each checked for format and count.
class AttributeReader {
  public:
    AttributeReader(const Document& document, const std::map<std::string, int>& attributes, std::string path, std::size_t vertices)
        : document_(document), attributes_(attributes), path_(std::move(path)), vertices_(vertices)
    {
    }

    std::optional<int> find(const std::string& name, std::string_view allowed) const
    {
        const auto found = attributes_.find(name);
        if (found == attributes_.end()) return std::nullopt;
        const std::string path = path_ + "." + name;
        requireFormat(document_, found->second, allowed, path);
        const std::size_t count = document_.model.accessors[std::size_t(found->second)].count;
        if (count != vertices_) document_.fail(path, "has " + countOf(count, "element") + ", POSITION has " + std::to_string(vertices_));
        return found->second;
    }

    template <class Vector>
    std::vector<Vector> vectors(const std::string& name, std::string_view allowed) const
    {
        const std::optional<int> accessor = find(name, allowed);
        return accessor ? readVectors<Vector>(document_, *accessor) : std::vector<Vector>{};
    }

    std::vector<Vec4> colors() const
    {
        const std::optional<int> accessor = find("COLOR_0", kColor);
        if (!accessor) return {};
        if (document_.model.accessors[std::size_t(*accessor)].type == TINYGLTF_TYPE_VEC4) return readVectors<Vec4>(document_, *accessor);
        std::vector<Vec4> result;
        for (const Vec3& rgb : readVectors<Vec3>(document_, *accessor)) result.emplace_back(rgb, 1.0f);
        return result;
    }

    /// JOINTS_n with WEIGHTS_n; weights brought to a sum of 1 over all sets later, where they are used.
    std::optional<Influences> influences(int set) const
    {
        const std::string n = std::to_string(set);
        const std::optional<int> joints = find("JOINTS_" + n, "VEC4 u8 u16"), weights = find("WEIGHTS_" + n, "VEC4 f nu8 nu16");
        if (!joints || !weights) return std::nullopt;
        const std::vector<std::uint32_t> flat = readIntegers(document_, *joints);
        Influences result;
        for (std::size_t i = 0; i < flat.size(); i += 4) result.joints.push_back({flat[i], flat[i + 1], flat[i + 2], flat[i + 3]});
        result.weights = readVectors<Vec4>(document_, *weights);
        return result;
    }

  private:
    const Document& document_;
    const std::map<std::string, int>& attributes_;
    std::string path_;
    std::size_t vertices_;
};

std::vector<std::uint32_t> readIndices(const Document& document, const tinygltf::Primitive& source, std::size_t vertices, const std::string& path)
{
    if (source.indices < 0) {
        std::vector<std::uint32_t> indices(vertices);
        for (std::size_t i = 0; i < vertices; ++i) indices[i] = std::uint32_t(i);
        return indices;
    }
    requireFormat(document, source.indices, "SCALAR u8 u16 u32", path + ".indices");
    std::vector<std::uint32_t> indices = readIntegers(document, source.indices);
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= vertices)
            document.fail(path + ".indices",
                          "element " + std::to_string(i) + " is " + std::to_string(indices[i]) + ", but there are " + countOf(vertices, "vertex"));
    return indices;
}

/// Triangles of a list, strip or fan with their winding kept (glTF 2.0, section 3.7.2.1); left-over indices are dropped.
std::vector<std::array<std::uint32_t, 3>> assembleTriangles(const std::vector<std::uint32_t>& index, int mode)
{
    std::vector<std::array<std::uint32_t, 3>> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        for (std::size_t i = 0; i + 2 < index.size(); i += 3) triangles.push_back({index[i], index[i + 1], index[i + 2]});
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (std::size_t i = 0; i + 2 < index.size(); ++i) triangles.push_back({index[i], index[i + (1 + i % 2)], index[i + (2 - i % 2)]});
    } else {
        for (std::size_t i = 0; i + 2 < index.size(); ++i) triangles.push_back({index[i + 1], index[i + 2], index[0]});
    }
    return triangles;
}

Primitive readPrimitive(const Document& document, const tinygltf::Primitive& source, const std::string& path, const std::vector<UvSets>& materialUvSets,
                        bool quantized)
{
    const std::size_t vertices = document.model.accessors[std::size_t(source.attributes.at("POSITION"))].count;
    const AttributeReader reader(document, source.attributes, path + ".attributes", vertices);

    Primitive primitive;
    primitive.material = source.material >= 0 ? source.material : int(materialUvSets.size() - 1);
    primitive.positions = reader.vectors<Vec3>("POSITION", quantized ? kQuantizedPosition : kFloat3);
    primitive.normals = reader.vectors<Vec3>("NORMAL", quantized ? kQuantizedNormal : kFloat3);
    // glTF: without normals the tangents are to be ignored too.
    if (!primitive.normals.empty()) primitive.tangents = reader.vectors<Vec4>("TANGENT", quantized ? kQuantizedTangent : "VEC4 f");
    const UvSets& sets = materialUvSets[std::size_t(primitive.material)];
    const auto uv = [&](int set) {
        return set < 0 ? std::vector<Vec2>{} : reader.vectors<Vec2>("TEXCOORD_" + std::to_string(set), quantized ? kQuantizedUv : kUv);
    };
    primitive.uv0 = uv(sets[0]);
    primitive.uv1 = uv(sets[1]);
    primitive.colors = reader.colors();
    for (int set = 0; set < 2; ++set)
        if (std::optional<Influences> influences = reader.influences(set)) primitive.influences.push_back(std::move(*influences));

    for (std::size_t t = 0; t < source.targets.size(); ++t) {
        const AttributeReader target(document, source.targets[t], at(path + ".targets", t), vertices);
        primitive.targets.push_back({target.vectors<Vec3>("POSITION", quantized ? kQuantizedPosition : kFloat3),
                                     target.vectors<Vec3>("NORMAL", quantized ? kQuantizedNormal : kFloat3)});
    }
    const int mode = source.mode < 0 ? TINYGLTF_MODE_TRIANGLES : source.mode;
    primitive.triangles = assembleTriangles(readIndices(document, source, vertices, path), mode);
    return primitive;
}

}  // namespace

void readMeshes(const Document& document, Asset& asset)
{
    const std::vector<std::string>& extensions = document.model.extensionsUsed;
    const bool quantized = std::find(extensions.begin(), extensions.end(), "KHR_mesh_quantization") != extensions.end();
    std::size_t notTriangles = 0, withoutPositions = 0;
    for (std::size_t m = 0; m < document.model.meshes.size(); ++m) {
        const tinygltf::Mesh& source = document.model.meshes[m];
        Mesh mesh;
        mesh.name = source.name.empty() ? "mesh " + std::to_string(m) : source.name;
        mesh.weights.assign(source.weights.begin(), source.weights.end());
        for (std::size_t p = 0; p < source.primitives.size(); ++p) {
            const tinygltf::Primitive& primitive = source.primitives[p];
            const bool triangles = primitive.mode < 0 || primitive.mode >= TINYGLTF_MODE_TRIANGLES;
            const bool positions = primitive.attributes.count("POSITION") > 0;
            notTriangles += !triangles;
            withoutPositions += triangles && !positions;
            if (triangles && positions)
                mesh.primitives.push_back(readPrimitive(document, primitive, at(at("meshes", m) + ".primitives", p), asset.materialUvSets, quantized));
        }
        asset.meshes.push_back(std::move(mesh));
    }
    if (notTriangles > 0) asset.notes.push_back(countOf(notTriangles, "primitive") + " of points or lines skipped");
    if (withoutPositions > 0) asset.notes.push_back(countOf(withoutPositions, "primitive") + " without POSITION skipped");
}

}  // namespace lrsm::gltf
