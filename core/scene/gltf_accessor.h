#pragma once

#include "core/base/math.h"
#include "core/scene/gltf_document.h"

#include <span>
#include <string_view>

/// Private to the glTF loader: accessors as typed arrays. Strides, sparse values and normalised integers are resolved.
namespace lrsm::gltf {

/// Buffer views lie in their buffers and accessors in their views, sparse ones too. All below relies on it.
void checkAccessors(const Document& document);

/// The bytes of a buffer view.
std::span<const unsigned char> bufferViewBytes(const Document& document, int view);

/// Which element and component types a use of an accessor allows: "VEC3 f", "VEC3 VEC4 f nu8 nu16" (n: normalised).
/// f float, u8, u16, u32, s8, s16 integers.
void requireFormat(const Document& document, int accessor, std::string_view allowed, const std::string& jsonPath);

/// All components in a row as float: normalised integers as unsigned c / max, signed max(c / max, -1), other integers as they are.
/// A NaN or infinity is an InputError naming the accessor.
std::vector<float> readFloats(const Document& document, int accessor);

/// Integer components in a row.
std::vector<std::uint32_t> readIntegers(const Document& document, int accessor);

/// readFloats as vectors; the accessor must have Vector::length() components.
template <class Vector>
std::vector<Vector> readVectors(const Document& document, int accessor)
{
    const std::vector<float> values = readFloats(document, accessor);
    constexpr std::size_t n = Vector::length();
    std::vector<Vector> vectors(values.size() / n);
    for (std::size_t i = 0; i < vectors.size(); ++i)
        for (std::size_t c = 0; c < n; ++c) vectors[i][int(c)] = values[i * n + c];
    return vectors;
}

}  // namespace lrsm::gltf
