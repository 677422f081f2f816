#include "core/base/formats.h"

#include "catch.h"

#include <bit>
#include <cmath>

using namespace lrsm;

TEST_CASE("half: every bit pattern survives the way to float and back, in both roundings", "[core][formats]")
{
    for (std::uint32_t bits = 0; bits < 0x10000u; ++bits) {
        const float value = floatFromHalf(static_cast<std::uint16_t>(bits));
        const bool nan = (bits & 0x7fffu) > 0x7c00u;
        REQUIRE(std::isnan(value) == nan);
        if (nan) continue;
        // Independent reading of the format: sign, exponent, fraction by ldexp.
        const int exponent = static_cast<int>((bits >> 10) & 31u), fraction = static_cast<int>(bits & 1023u);
        double expected = exponent == 31 ? std::numeric_limits<double>::infinity()
                          : exponent     ? std::ldexp(1024 + fraction, exponent - 25)
                                         : std::ldexp(fraction, -24);
        if (bits & 0x8000u) expected = -expected;
        REQUIRE(static_cast<double>(value) == expected);
        REQUIRE(halfFromFloat(value, HalfRounding::d3d) == bits);
        REQUIRE(halfFromFloat(value, HalfRounding::nearestEven) == bits);
    }
}

TEST_CASE("half: between two neighbours d3d goes toward zero, nearest-even to the nearer, ties to even", "[core][formats]")
{
    for (std::uint32_t bits = 0; bits < 0x7bffu; ++bits) {
        const auto lower = static_cast<std::uint16_t>(bits), upper = static_cast<std::uint16_t>(bits + 1);
        const float a = floatFromHalf(lower), b = floatFromHalf(upper), middle = 0.5f * (a + b);  // exact in float
        for (const float x : {std::nextafter(a, b), std::nextafter(middle, a), middle, std::nextafter(middle, b), std::nextafter(b, a)}) {
            REQUIRE(halfFromFloat(x, HalfRounding::d3d) == lower);
            REQUIRE(halfFromFloat(-x, HalfRounding::d3d) == (lower | 0x8000u));
            const auto nearest = x < middle ? lower : x > middle ? upper : (lower & 1u) ? upper : lower;
            REQUIRE(halfFromFloat(x, HalfRounding::nearestEven) == nearest);
            REQUIRE(halfFromFloat(-x, HalfRounding::nearestEven) == (nearest | 0x8000u));
        }
    }
}

TEST_CASE("half: overflow saturates in d3d and becomes infinity in nearest-even; infinity and NaN stay", "[core][formats]")
{
    const float inf = std::numeric_limits<float>::infinity();
    for (const float big : {65505.0f, 65519.9f, 65520.0f, 65536.0f, 1e10f, std::numeric_limits<float>::max()}) {
        CHECK(halfFromFloat(big, HalfRounding::d3d) == 0x7bffu);
        CHECK(halfFromFloat(-big, HalfRounding::d3d) == 0xfbffu);
        CHECK(halfFromFloat(big, HalfRounding::nearestEven) == (big < 65520.0f ? 0x7bffu : 0x7c00u));
    }
    for (const auto mode : {HalfRounding::d3d, HalfRounding::nearestEven}) {
        CHECK(halfFromFloat(inf, mode) == 0x7c00u);
        CHECK(halfFromFloat(-inf, mode) == 0xfc00u);
        CHECK(std::isnan(floatFromHalf(halfFromFloat(std::numeric_limits<float>::quiet_NaN(), mode))));
    }
    ConversionCounts counts;
    CHECK(roundToHalf(1e6f, HalfRounding::d3d, counts) == 65504.0f);
    roundToHalf(inf, HalfRounding::d3d, counts);
    roundToHalf(std::nanf(""), HalfRounding::d3d, counts);
    // What a pass stores saturates in either mode: an infinite texel would be NaN under a filter's weight of 0.
    CHECK(roundToHalf(-1e6f, HalfRounding::nearestEven, counts) == -65504.0f);
    CHECK(roundToHalf(65519.0f, HalfRounding::nearestEven, counts) == 65504.0f);
    CHECK(counts.halfSaturations == 3);
    CHECK(counts.nans == 1);
}

TEST_CASE("unorm8 and unorm16: all codes round-trip; the step lies halfway, and belongs to the upper code", "[core][formats]")
{
    for (std::uint32_t code = 0; code < 0x10000u; ++code) {
        REQUIRE(unorm16FromFloat(floatFromUnorm16(static_cast<std::uint16_t>(code))) == code);
        REQUIRE(static_cast<double>(floatFromUnorm16(static_cast<std::uint16_t>(code))) == Approx(code / 65535.0).epsilon(1e-7));
    }
    for (std::uint32_t code = 0; code < 255u; ++code) {
        REQUIRE(unorm8FromFloat(floatFromUnorm8(static_cast<std::uint8_t>(code))) == code);
        const auto halfway = static_cast<float>((code + 0.5) / 255.0);
        REQUIRE(unorm8FromFloat(halfway * (1.0f - 1e-6f)) == code);
        REQUIRE(unorm8FromFloat(halfway * (1.0f + 1e-6f)) == code + 1);
    }
    for (const float low : {-1.0f, -0.0f, std::nanf(""), -std::numeric_limits<float>::infinity()}) {
        CHECK(unorm8FromFloat(low) == 0);
        CHECK(unorm16FromFloat(low) == 0);
    }
    for (const float high : {1.0f, 1.5f, std::numeric_limits<float>::infinity()}) {
        CHECK(unorm8FromFloat(high) == 255);
        CHECK(unorm16FromFloat(high) == 65535);
    }
}

TEST_CASE("sRGB: all codes round-trip and follow the standard's curve", "[core][formats]")
{
    for (int code = 0; code < 256; ++code) {
        const float linear = linearFromSrgb8(static_cast<std::uint8_t>(code));
        REQUIRE(srgb8FromLinear(linear) == code);
        const double c = code / 255.0;
        REQUIRE(static_cast<double>(linear) == Approx(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4)).epsilon(1e-6));
    }
}
