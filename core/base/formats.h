#pragma once

#include "core/base/math.h"

#include <array>
#include <cstdint>

/// Exact conversions to and from the GPU's formats, as the D3D11.3 functional specification's ideal defines them.
namespace lrsm {

enum class HalfRounding { d3d, nearestEven };  ///< toward zero, overflow to 65504 (D3D11); or nearest even (Vulkan's usual)

/// IEEE binary16 bit pattern. `d3d`: toward zero, finite overflow becomes +-65504 (section 3.2.2); `nearestEven`: IEEE default, overflow
/// becomes infinity. NaN stays NaN (quiet), infinity stays infinity, denormals are kept.
std::uint16_t halfFromFloat(float value, HalfRounding rounding);
float floatFromHalf(std::uint16_t bits);

/// FLOAT to UNORM (section 3.2.3.6): NaN becomes 0, clamp to [0, 1], times 2^n - 1, plus 0.5, drop the fraction.
std::uint8_t unorm8FromFloat(float value);
std::uint16_t unorm16FromFloat(float value);
/// By how much more than half a code a conversion may be off, because c (2^n - 1) + 0.5 is itself rounded to float.
inline constexpr double kUnorm8EdgeError = 1e-5, kUnorm16EdgeError = 0.004;
/// UNORM to FLOAT: bits / (2^n - 1), correctly rounded.
float floatFromUnorm8(std::uint8_t bits);
float floatFromUnorm16(std::uint16_t bits);

/// What a pass counts when it converts: never silent.
struct ConversionCounts {
    std::uint64_t halfSaturations = 0;  ///< finite values beyond 65504
    std::uint64_t nans = 0;
    ConversionCounts& operator+=(const ConversionCounts& other)
    {
        halfSaturations += other.halfSaturations;
        nans += other.nans;
        return *this;
    }
};

/// value -> half -> float, counting. A finite value beyond half's range becomes +-65504 in both modes, as Vulkan and OpenGL allow and D3D11
/// demands: an infinite texel would turn to NaN under a filter's weight of 0. halfFromFloat itself is IEEE's.
float roundToHalf(float value, HalfRounding rounding, ConversionCounts& counts);
float roundToUnorm16(float value, ConversionCounts& counts);

/// sRGB electro-optical transfer function, 8-bit code to linear [0, 1], and back (nearest code).
float linearFromSrgb8(std::uint8_t code);
std::uint8_t srgb8FromLinear(float linear);

}  // namespace lrsm
