#pragma once

#include "core/settings/settings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

/// Table 1's formats once more, read from their definitions in double; none of core/base/formats.h is used.
namespace lrsm::oracle {

/// What a half's bits mean.
inline double valueOfHalf(std::uint32_t bits)
{
    const int exponent = static_cast<int>((bits >> 10) & 31u), fraction = static_cast<int>(bits & 1023u);
    const double magnitude = exponent == 31 ? std::numeric_limits<double>::infinity()
                             : exponent     ? std::ldexp(1024 + fraction, exponent - 25)
                                            : std::ldexp(fraction, -24);
    return (bits & 0x8000u) ? -magnitude : magnitude;
}

/// The half that a finite number becomes, by dividing by the spacing of halves there.
inline double half(double value, HalfRounding rounding)
{
    const double magnitude = std::abs(value);
    if (magnitude == 0.0) return value;
    int exponent = 0;
    std::frexp(magnitude, &exponent);
    const double spacing = std::ldexp(1.0, std::max(exponent - 11, -24)), count = magnitude / spacing, whole = std::floor(count);
    double rounded = whole;
    if (rounding == HalfRounding::nearestEven && (count - whole > 0.5 || (count - whole == 0.5 && std::fmod(whole, 2.0) == 1.0))) rounded += 1.0;
    double result = rounded * spacing;
    if (result > 65504.0) result = rounding == HalfRounding::d3d ? 65504.0 : std::numeric_limits<double>::infinity();
    return std::copysign(result, value);
}

/// The 16-bit UNORM that a number becomes; c 65535 + 0.5 in float, as D3D's rule is carried out.
inline double unorm16(float value)
{
    const float c = value > 0.0f ? std::min(value, 1.0f) : 0.0f, scaled = c * 65535.0f;
    return double(static_cast<float>(std::floor(double(scaled + 0.5f)) / 65535.0));
}

}  // namespace lrsm::oracle
