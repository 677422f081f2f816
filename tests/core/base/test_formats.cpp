// Every pattern, edge and rounding is held against double in apps/validate/equations/format_checks.cpp; here are the traps, and sRGB.
#include "core/base/formats.h"

#include "catch.h"

#include <cmath>

using namespace lrsm;

TEST_CASE("half: overflow saturates in d3d and becomes infinity in nearest-even, infinity and NaN stay", "[core][formats]")
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

TEST_CASE("unorm8 and unorm16: NaN and what is below are 0, what is above is 1", "[core][formats]")
{
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
