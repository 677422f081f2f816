#include "core/base/formats.h"

#include "core/base/elementary.h"

#include <bit>
#include <cmath>

namespace lrsm {
namespace {

constexpr std::uint32_t kFloatInfinity = 0x7f800000u;
constexpr std::uint16_t kHalfInfinity = 0x7c00u, kHalfLargest = 0x7bffu, kHalfQuietNaN = 0x7e00u;

/// Magnitude bits of a finite float below 2^16 -> half magnitude, discarding low bits as the mode says.
std::uint32_t halfMagnitude(std::uint32_t magnitude, HalfRounding rounding)
{
    const auto exponent = static_cast<int>(magnitude >> 23) - 127;
    if (exponent < -25) return 0;  // below half of the smallest denormal

    // Normal halves drop 13 mantissa bits; denormal ones drop more, and the hidden bit becomes explicit.
    const bool denormal = exponent < -14;
    const std::uint32_t significand = denormal ? ((magnitude & 0x007fffffu) | 0x00800000u) : magnitude - (112u << 23);
    const int shift = denormal ? -exponent - 1 : 13;
    std::uint32_t half = significand >> shift;
    if (rounding == HalfRounding::nearestEven) {
        const std::uint32_t rest = significand & ((1u << shift) - 1u), tie = 1u << (shift - 1);
        if (rest > tie || (rest == tie && (half & 1u))) ++half;  // may carry into the exponent: that is the right answer
    }
    return half;
}

}  // namespace

std::uint16_t halfFromFloat(float value, HalfRounding rounding)
{
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const auto sign = static_cast<std::uint16_t>((bits >> 16) & 0x8000u);
    const std::uint32_t magnitude = bits & 0x7fffffffu;
    if (magnitude > kFloatInfinity) return static_cast<std::uint16_t>(sign | kHalfQuietNaN);
    if (magnitude == kFloatInfinity) return static_cast<std::uint16_t>(sign | kHalfInfinity);

    std::uint32_t half = magnitude >= (143u << 23) ? kHalfInfinity : halfMagnitude(magnitude, rounding);  // 143: 2^16 and up
    if (rounding == HalfRounding::d3d && half > kHalfLargest) half = kHalfLargest;
    return static_cast<std::uint16_t>(sign | half);
}

float floatFromHalf(std::uint16_t bits)
{
    const std::uint32_t sign = static_cast<std::uint32_t>(bits & 0x8000u) << 16;
    const std::uint32_t magnitude = bits & 0x7fffu;
    if (magnitude >= kHalfInfinity) return std::bit_cast<float>(sign | kFloatInfinity | ((magnitude & 0x3ffu) << 13));
    if (magnitude >= 0x0400u) return std::bit_cast<float>(sign | ((magnitude << 13) + (112u << 23)));
    const float denormal = static_cast<float>(magnitude) * 0x1p-24f;
    return sign ? -denormal : denormal;
}

std::uint8_t unorm8FromFloat(float value)
{
    if (!(value > 0.0f)) return 0;
    return static_cast<std::uint8_t>(std::min(value, 1.0f) * 255.0f + 0.5f);
}

std::uint16_t unorm16FromFloat(float value)
{
    if (!(value > 0.0f)) return 0;
    return static_cast<std::uint16_t>(std::min(value, 1.0f) * 65535.0f + 0.5f);
}

float floatFromUnorm8(std::uint8_t bits)
{
    return static_cast<float>(bits) / 255.0f;
}

float floatFromUnorm16(std::uint16_t bits)
{
    return static_cast<float>(bits) / 65535.0f;
}

float roundToHalf(float value, HalfRounding rounding, ConversionCounts& counts)
{
    if (std::isnan(value)) ++counts.nans;
    constexpr float kLargest = 65504.0f;
    if (std::isfinite(value) && std::abs(value) > kLargest) {
        ++counts.halfSaturations;
        return std::copysign(kLargest, value);
    }
    return floatFromHalf(halfFromFloat(value, rounding));
}

float roundToUnorm16(float value, ConversionCounts& counts)
{
    if (std::isnan(value)) ++counts.nans;
    return floatFromUnorm16(unorm16FromFloat(value));
}

float linearFromSrgb8(std::uint8_t code)
{
    const double c = static_cast<double>(code) / 255.0;
    return static_cast<float>(c <= 0.04045 ? c / 12.92 : power((c + 0.055) / 1.055, 2.4));
}

std::uint8_t srgb8FromLinear(float linear)
{
    if (!(linear > 0.0f)) return 0;
    if (linear >= 1.0f) return 255;
    const double l = linear;
    const double c = l <= 0.0031308 ? 12.92 * l : 1.055 * power(l, 1.0 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(c * 255.0 + 0.5);
}

}  // namespace lrsm
