#pragma once

#include "core/base/simd.h"
#include "core/settings/settings.h"

#include <bit>
#include <cstdint>
#include <cstring>

/// What the opacity pyramid's lookups are made of, four lanes at a time (core/base/simd.h).
namespace lrsm::sampling {

using Long2 = std::int64_t __attribute__((vector_size(16)));
using Short8 = std::int16_t __attribute__((vector_size(16)));
using Byte16 = std::int8_t __attribute__((vector_size(16)));

inline bool all(Int4 mask)
{
    const auto halves = reinterpret_cast<Long2>(mask);
    return (halves[0] & halves[1]) == -1;
}
inline Float4 keep(Int4 mask, Float4 v)
{
    return reinterpret_cast<Float4>(mask & reinterpret_cast<Int4>(v));
}

/// a + f (b - a), 0 <= f < 1. Exact at f = 0 and for a == b; monotone in f; and never outside [min(a, b), max(a, b)]: f is at most
/// 1 - 2^-24, so the rounded product is at most the exact b - a, and rounding is monotone.
inline Float4 lerp(Float4 a, Float4 b, Float4 f)
{
    return a + f * (b - a);
}

inline Int4 floorToInt(Float4 t)
{
    const Int4 i = __builtin_convertvector(t, Int4);
    return i + (__builtin_convertvector(i, Float4) > t);
}

/// 2^-exponent, 0 <= exponent < 127.
inline float inversePower(int exponent)
{
    return std::bit_cast<float>(std::uint32_t(127 - exponent) << 23);
}

/// The lower texel of the 2x2x2 that a lookup blends, and the fractions toward the upper ones.
struct Footprint {
    Int4 cell;
    Float4 f;
};

/// Clamped to where all eight texels are border (also NaN), so that far coordinates stay in int's range.
template <FilterFraction fraction>
inline Footprint footprint(Float4 pVoxels, float texelsPerVoxel, int n)
{
    Float4 t = pVoxels * splat(texelsPerVoxel) - splat(0.5f);
    const Float4 low = splat(-2.0f), high = splat(float(n + 1));
    t = t > low ? t : low;
    t = t < high ? t : high;
    if constexpr (fraction == FilterFraction::fixed8) t = __builtin_convertvector(floorToInt(t * splat(256.0f) + splat(0.5f)), Float4) * splat(1.0f / 256.0f);
    const Int4 cell = floorToInt(t);
    return {cell, t - __builtin_convertvector(cell, Float4)};
}

/// Blends eight values over x, then y, then z: lower[k] and upper[k] are the texels at x and x + 1 of row k = dy + 2 dz.
inline float blendRows(Float4 lower, Float4 upper, Float4 f)
{
    const Float4 x = lerp(lower, upper, splat(f[0]));
    const float y0 = x[0] + f[1] * (x[1] - x[0]);
    const float y1 = x[2] + f[1] * (x[3] - x[2]);
    return y0 + f[2] * (y1 - y0);
}

/// Blends eight vectors lane by lane over x, then y, then z: corner[dx + 2 dy + 4 dz].
inline Float4 blendCorners(const Float4 (&corner)[8], Float4 f)
{
    const Float4 fx = splat(f[0]), fy = splat(f[1]), fz = splat(f[2]);
    const Float4 y0 = lerp(lerp(corner[0], corner[1], fx), lerp(corner[2], corner[3], fx), fy);
    const Float4 y1 = lerp(lerp(corner[4], corner[5], fx), lerp(corner[6], corner[7], fx), fy);
    return lerp(y0, y1, fz);
}

/// Four bytes to four floats.
inline Float4 widen(std::uint32_t bytes)
{
    const Byte16 packed = reinterpret_cast<Byte16>(Int4{std::int32_t(bytes), 0, 0, 0});
    const Short8 words = reinterpret_cast<Short8>(__builtin_shufflevector(packed, Byte16{}, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
    const Int4 lanes = reinterpret_cast<Int4>(__builtin_shufflevector(words, Short8{}, 0, 8, 1, 9, 2, 10, 3, 11));
    return __builtin_convertvector(lanes, Float4);
}

/// Four consecutive stored values.
inline Float4 loadFour(const std::uint8_t* values)
{
    std::uint32_t bytes;
    std::memcpy(&bytes, values, sizeof bytes);
    return widen(bytes);
}
inline Float4 loadFour(const float* values)
{
    Float4 lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
}

/// Three consecutive stored values where a fourth may not exist.
inline Float4 loadThree(const std::uint8_t* values)
{
    return widen(std::uint32_t(values[0]) | std::uint32_t(values[1]) << 8 | std::uint32_t(values[2]) << 16);
}
inline Float4 loadThree(const float* values)
{
    return Float4{values[0], values[1], values[2], 0.0f};
}

/// Two neighbours along x in each of four rows, to lower and upper.
inline void loadPairs(const std::uint8_t* const (&row)[4], Float4& lower, Float4& upper)
{
    std::uint16_t pair[4];
    for (int k = 0; k < 4; ++k) std::memcpy(&pair[k], row[k], sizeof pair[k]);
    const Int4 both = {pair[0], pair[1], pair[2], pair[3]};
    lower = __builtin_convertvector(both & 255, Float4);
    upper = __builtin_convertvector(both >> 8, Float4);
}
inline void loadPairs(const float* const (&row)[4], Float4& lower, Float4& upper)
{
    lower = Float4{row[0][0], row[1][0], row[2][0], row[3][0]};
    upper = Float4{row[0][1], row[1][1], row[2][1], row[3][1]};
}

}  // namespace lrsm::sampling
