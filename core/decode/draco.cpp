#include "core/decode/decode.h"

#include <draco/compression/decode.h>

#include <cstring>

namespace lrsm {
namespace {

template <class T>
bool convertPoints(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int components, Bytes& out)
{
    out.resize(std::size_t(mesh.num_points()) * std::size_t(components) * sizeof(T));
    T values[4] = {};
    for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
        const draco::AttributeValueIndex index = attribute.mapped_index(draco::PointIndex(p));
        if (index.value() >= attribute.size() || !attribute.ConvertValue<T>(index, std::int8_t(components), values)) return false;
        std::memcpy(&out[std::size_t(p) * std::size_t(components) * sizeof(T)], values, std::size_t(components) * sizeof(T));
    }
    return true;
}

bool convert(const draco::Mesh& mesh, const DracoAttribute& wanted, Bytes& out)
{
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(wanted.id);
    if (!attribute || wanted.components < 1 || wanted.components > 4 || attribute->num_components() < wanted.components) return false;
    switch (wanted.componentType) {
    case 5120: return convertPoints<std::int8_t>(mesh, *attribute, wanted.components, out);
    case 5121: return convertPoints<std::uint8_t>(mesh, *attribute, wanted.components, out);
    case 5122: return convertPoints<std::int16_t>(mesh, *attribute, wanted.components, out);
    case 5123: return convertPoints<std::uint16_t>(mesh, *attribute, wanted.components, out);
    case 5125: return convertPoints<std::uint32_t>(mesh, *attribute, wanted.components, out);
    case 5126: return convertPoints<float>(mesh, *attribute, wanted.components, out);
    default: return false;
    }
}

}  // namespace

std::optional<DracoMesh> decodeDraco(std::span<const unsigned char> bytes, std::span<const DracoAttribute> attributes)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return {};
    const draco::Mesh& mesh = *decoded.value();

    DracoMesh result;
    result.points = mesh.num_points();
    for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
        for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(f))) {
            if (corner.value() >= result.points) return {};
            result.indices.push_back(corner.value());
        }
    for (const DracoAttribute& wanted : attributes)
        if (!convert(mesh, wanted, result.attributes.emplace_back())) return {};
    return result;
}

}  // namespace lrsm
