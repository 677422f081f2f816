#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// Compressed meshes and pictures inside glTF files, by the libraries of their makers: meshoptimizer, Draco, libwebp. Nothing else may include those.
/// Each gives nothing for bytes that are damaged or not of its kind.
namespace lrsm {

using Bytes = std::vector<unsigned char>;

/// False where this program was built without the three (LRSM_PASSES_ONLY).
bool hasDecoders();

/// EXT_meshopt_compression: what a compressed buffer view holds.
struct MeshoptStream {
    enum class Mode { attributes, triangles, indices };
    enum class Filter { none, octahedral, quaternion, exponential };
    Mode mode = Mode::attributes;
    Filter filter = Filter::none;
    std::size_t count = 0;   ///< elements
    std::size_t stride = 0;  ///< bytes an element: attributes 4 .. 256 in fours, indices 2 or 4
};
/// count * stride bytes.
std::optional<Bytes> decodeMeshopt(std::span<const unsigned char> bytes, const MeshoptStream& stream);

/// An attribute of a Draco mesh as it is wanted: KHR_draco_mesh_compression's id, and the glTF accessor's form.
struct DracoAttribute {
    std::uint32_t id = 0;
    int componentType = 5126;  ///< glTF's: 5120 .. 5126
    int components = 3;        ///< 1 .. 4
};
struct DracoMesh {
    std::size_t points = 0;
    std::vector<std::uint32_t> indices;  ///< three a triangle, below `points`
    std::vector<Bytes> attributes;       ///< in the order asked for: points * components values, packed
};
std::optional<DracoMesh> decodeDraco(std::span<const unsigned char> bytes, std::span<const DracoAttribute> attributes);

struct WebpSize {
    int width = 0, height = 0;
};
/// From the header alone.
std::optional<WebpSize> webpSize(std::span<const unsigned char> bytes);
/// RGBA, 8 bits each, not premultiplied, row 0 at the top. Nothing for an animation too.
std::optional<Bytes> decodeWebp(std::span<const unsigned char> bytes);

}  // namespace lrsm
