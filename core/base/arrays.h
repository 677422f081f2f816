#pragma once

#include "core/base/hash.h"
#include "core/base/image.h"
#include "core/base/math.h"

#include <cstdint>
#include <string>
#include <type_traits>

/// What a pass makes is a struct of arrays. forEachArray(output, visit), which stands beside each such struct, calls visit(array, traits) for each of
/// them, always in the same order: sizes, hash and the count of non-finite values are written once, here.
namespace lrsm {

struct ArrayTraits {
    std::size_t gpuBytes = 0;  ///< of the whole array in the GPU's formats
    bool hashed = true;        ///< false: follows from the other arrays and is kept for speed alone
};

/// A picture: half x4 for colours, as it is for all else.
template <class T, class Visit>
void forEachArray(const Image<T>& image, Visit&& visit)
{
    constexpr std::size_t kHalf4Bytes = 8;
    visit(image.texels, ArrayTraits{image.texels.size() * (std::is_same_v<T, Vec3> ? kHalf4Bytes : sizeof(T))});
}

template <class Output>
std::size_t bytesOf(const Output& output)
{
    std::size_t bytes = 0;
    forEachArray(output, [&](const auto& array, const ArrayTraits&) { bytes += array.size() * sizeof(array[0]); });
    return bytes;
}

template <class Output>
std::size_t gpuBytesOf(const Output& output)
{
    std::size_t bytes = 0;
    forEachArray(output, [&](const auto&, const ArrayTraits& traits) { bytes += traits.gpuBytes; });
    return bytes;
}

/// SHA-256 of every value; no padding, no timing.
template <class Output>
std::string hashOf(const Output& output)
{
    Sha256 hash;
    forEachArray(output, [&](const auto& array, const ArrayTraits& traits) {
        if (traits.hashed) hash.add(array);
    });
    return hash.hex();
}

/// Of `count` floats in a row: those whose exponent is all ones. Parallel.
std::uint64_t countNonFiniteFloats(const float* values, std::size_t count);

/// NaNs and infinities among the values that a pass hands on. None may leave a pass, whatever comes in; one read of the output, which is little
/// beside making it. Elements that are no integers hold floats alone.
template <class Output>
std::uint64_t countNonFinite(const Output& output)
{
    std::uint64_t found = 0;
    forEachArray(output, [&](const auto& array, const ArrayTraits&) {
        using T = std::remove_cvref_t<decltype(array[0])>;
        if constexpr (!std::is_integral_v<T>) {
            static_assert(sizeof(T) % sizeof(float) == 0 && alignof(T) % alignof(float) == 0);
            found += countNonFiniteFloats(reinterpret_cast<const float*>(array.data()), array.size() * (sizeof(T) / sizeof(float)));
        }
    });
    return found;
}

}  // namespace lrsm
