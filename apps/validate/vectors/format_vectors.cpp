// Table 1's formats.
#include "apps/validate/equations/format_oracle.h"
#include "apps/validate/vectors/make_vectors.h"
#include "apps/validate/vectors/set_parts.h"
#include "core/base/formats.h"

namespace lrsm {
namespace {

/// D3D11.3 lets a conversion to UNORM be off by this many codes.
constexpr NamedBound kUnormMaxError{"D3D11.3's conversion to UNORM", 0.6};

void addHalf(std::vector<VectorSet>& sets)
{
    VectorSet& set = sets.emplace_back(VectorSet{
        .name = "half",
        .meaning = "float32 to half, as a value",
        .inputs = {{"x", {}, "", ""}},
        .outputs = {outputOf("table1", {"table1.half_toward_zero", {}, "", "rounded toward zero, 65504 beyond it (D3D11; half_rounding=d3d)"}, {"exact", 0.0}),
                    outputOf("table1",
                             {"table1.half_nearest_even", {}, "", "rounded to the nearest, ties to even; x is below 65520 (half_rounding=nearest_even)"},
                             {"exact", 0.0})},
        .kinds = {}});
    SearchSpace<float, 1> space{{{{0x1p-26f, 65519.0f, Spacing::signedLogarithmic}}}, {{0.0f}}};
    for (const float x : {65504.0f, 1.0f, 0x1p-14f, 0x1p-24f, 0x1p-25f, 2049.0f / 2048.0f, 2051.0f / 2048.0f, 1.5f * 0x1p-24f})
        for (const int ulps : {-1, 0, 1}) space.planted.insert(space.planted.end(), {{moveByUlps(x, ulps)}, {-moveByUlps(x, ulps)}});
    fillSet(set, space,
            [](const std::array<float, 1>& in) {
                ConversionCounts counts;
                const auto of = [&](HalfRounding rounding) {
                    return single(oracle::half(double(in[0]), rounding), 0.0, double(roundToHalf(in[0], rounding, counts)));
                };
                return VectorCase{{{double(in[0])}}, {of(HalfRounding::d3d), of(HalfRounding::nearestEven)}};
            },
            1600, {.typical = 256, .worst = 0, .search = 32});

    VectorSet& decoded = sets.emplace_back(VectorSet{.name = "half_bits",
                                                     .meaning = "half to float32",
                                                     .inputs = {{"bits", {}, "", "of the half", Dtype::u2}},
                                                     .outputs = {outputOf("table1", {"table1.float_from_half", {}, "", "its value"}, {"exact", 0.0})},
                                                     .kinds = {}});
    const auto decode = [](std::uint32_t bits) {
        return VectorCase{{{double(bits)}}, {single(oracle::valueOfHalf(bits), 0.0, double(floatFromHalf(static_cast<std::uint16_t>(bits))))}};
    };
    for (std::uint32_t bits = 0x35u; bits < 0x7c00u; bits += 0x7fu)
        for (const std::uint32_t sign : {0u, 0x8000u}) addCase(decoded, CaseKind::typical, decode(sign | bits));
    for (const std::uint32_t bits : {0u, 1u, 0x3ffu, 0x400u, 0x7bffu, 0x8001u, 0xfbffu}) addCase(decoded, CaseKind::extreme, decode(bits));
}

template <class Encode>
void addUnorm(std::vector<VectorSet>& sets, const std::string& name, int largest, const Encode& encode)
{
    VectorSet& set = sets.emplace_back(VectorSet{
        .name = name,
        .meaning = "float32 to UNORM: clamped to 0 .. 1, scaled, to the nearest code",
        .inputs = {{"x", {}, "", ""}},
        .outputs = {outputOf("table1",
                             {"table1." + name, {}, "codes", "the code; the exact result is not rounded to one", largest > 255 ? Dtype::u2 : Dtype::u1},
                             kUnormMaxError, "codes")},
        .kinds = {}});
    SearchSpace<float, 1> space{{{{-0.5f, 1.5f}}}, {{0.0f}, {1.0f}, {-1.0f}, {2.0f}, {1e30f}}};
    for (const int code : {0, 1, largest / 2, largest - 1})
        for (const int ulps : {-2, -1, 1, 2}) space.planted.push_back({moveByUlps(static_cast<float>((code + 0.5) / largest), ulps)});
    fillSet(
        set, space,
        [&](const std::array<float, 1>& in) {
            return VectorCase{{{double(in[0])}}, {single(std::clamp(double(in[0]), 0.0, 1.0) * largest, kUnormMaxError.value, double(encode(in[0])))}};
        },
        1610);
}

}  // namespace

void addFormatVectors(std::vector<VectorSet>& sets)
{
    addHalf(sets);
    addUnorm(sets, "unorm16", 65535, unorm16FromFloat);
    addUnorm(sets, "unorm8", 255, unorm8FromFloat);
}

}  // namespace lrsm
