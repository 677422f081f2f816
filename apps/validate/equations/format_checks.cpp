// Table 1's formats: every 16-bit pattern, and the floats beside every point where a conversion changes its mind.
#include "core/base/formats.h"

#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/format_oracle.h"

namespace lrsm {
namespace {

using oracle::valueOfHalf;

/// Floats about the half `bits`: itself, the middle to the next, and their neighbours.
float aboutHalf(std::uint64_t i)
{
    const auto bits = static_cast<std::uint32_t>(i / 8);
    const auto a = static_cast<float>(valueOfHalf(bits)), b = bits % 0x8000u < 0x7bffu ? static_cast<float>(valueOfHalf(bits + 1))
                                                              : (bits & 0x8000u)       ? -65536.0f
                                                                                       : 65536.0f;
    const float middle = 0.5f * a + 0.5f * b;
    switch (i % 8) {
    case 0: return a;
    case 1: return moveByUlps(a, 1);
    case 2: return moveByUlps(a, -1);
    case 3: return middle;
    case 4: return moveByUlps(middle, 1);
    case 5: return moveByUlps(middle, -1);
    case 6: return 0.75f * a + 0.25f * b;
    default: return 0.25f * a + 0.75f * b;
    }
}

void checkHalf(CheckRun& run)
{
    auto decode = exhaust(0x10000u, [](std::uint64_t i) {
        const float value = floatFromHalf(static_cast<std::uint16_t>(i));
        if ((i & 0x7fffu) > 0x7c00u) return std::isnan(value) ? 0.0 : 1.0;
        return double(value) == valueOfHalf(static_cast<std::uint32_t>(i)) && std::signbit(value) == ((i & 0x8000u) != 0) ? 0.0 : 1.0;
    });
    run.add(exactCheck("table1", "floatFromHalf", "the format's definition, in double", "all 65536 patterns"), decode, "bits = " + exactText(decode.input[0]));

    for (const HalfRounding rounding : {HalfRounding::d3d, HalfRounding::nearestEven}) {
        const auto wrong = [rounding](float x) {
            const float got = floatFromHalf(halfFromFloat(x, rounding));
            const double expected = std::isinf(x) ? std::abs(double(x)) : oracle::half(std::abs(double(x)), rounding);
            return std::abs(double(got)) == expected && std::signbit(got) == std::signbit(x) ? 0.0 : 1.0;
        };
        auto beside = exhaust(0x10000u * 8u, [&](std::uint64_t i) { return ((i / 8) & 0x7fffu) >= 0x7c00u ? -1.0 : wrong(aboutHalf(i)); });
        const SearchSpace<float, 1> everywhere{
            {{{0x1p-30f, 0x1p20f, Spacing::signedLogarithmic}}},
            {{65504.0f}, {65520.0f}, {65536.0f}, {-65504.0f}, {0x1p-14f}, {0x1p-24f}, {0x1p-25f}, {-0x1p-25f}, {0x1p-26f}, {3e38f}, {0.0f}}};
        const auto random = findWorst(
            everywhere, run.budget(300000), [&](const auto& in) { return wrong(in[0]); }, 201);
        const std::string at = random.error > beside.error ? exactText(random.input[0]) : exactText(aboutHalf(static_cast<std::uint64_t>(beside.input[0])));
        beside.include(Worst<double, 1>{{0.0}, random.error, random.sum, random.swept, random.evaluations});
        run.add({.equation = "table1",
                 .function = std::string("halfFromFloat, ") + (rounding == HalfRounding::d3d ? "toward zero" : "nearest even"),
                 .oracle = "division by the spacing, in double",
                 .domain = "about all halves and their middles; 2^-30 .. 2^20",
                 .errorKind = "wrong results",
                 .bound = {"exact", 0.0},
                 .nanoseconds = run.time(4096, [rounding](std::size_t i) { return halfFromFloat(0.01f * float(i), rounding); })},
                beside, "x = " + at);
    }
    const auto special = exhaust(6, [](std::uint64_t i) {
        const HalfRounding rounding = i % 2 ? HalfRounding::nearestEven : HalfRounding::d3d;
        const float infinity = std::numeric_limits<float>::infinity();
        if (i / 2 == 0) return std::isnan(floatFromHalf(halfFromFloat(std::numeric_limits<float>::quiet_NaN(), rounding))) ? 0.0 : 1.0;
        return floatFromHalf(halfFromFloat(i / 2 == 1 ? infinity : -infinity, rounding)) == (i / 2 == 1 ? infinity : -infinity) ? 0.0 : 1.0;
    });
    run.add(exactCheck("table1", "halfFromFloat, NaN and infinity", "D3D11.3 3.2.2", "both roundings"), special, "case " + exactText(special.input[0]));

    const auto counted = exhaust(8, [](std::uint64_t i) {
        constexpr float kValues[4] = {65504.0f, 65504.004f, 65536.0f, -65505.0f};
        ConversionCounts counts;
        const float stored = roundToHalf(kValues[i / 2], i % 2 ? HalfRounding::nearestEven : HalfRounding::d3d, counts);
        if (stored != std::copysign(65504.0f, kValues[i / 2])) return 1.0;
        return counts.halfSaturations == (i / 2 ? 1u : 0u) && counts.nans == 0 ? 0.0 : 1.0;
    });
    run.add(exactCheck("table1", "roundToHalf, saturation", "65504, counted if finite and beyond", "65504 and its neighbour, both signs"), counted,
            "case " + exactText(counted.input[0]));
}

/// Codes of an n-bit UNORM, and the floats beside the exact edge (k + 1/2) / (2^n - 1) between two of them.
template <class Encode, class Decode>
void checkUnorm(CheckRun& run, const char* name, unsigned codes, double slack, const char* slackName, const Encode& encode, const Decode& decode)
{
    auto roundTrip = exhaust(codes, [&](std::uint64_t i) {
        const float value = decode(i);
        return double(value) == double(static_cast<float>(double(i) / (codes - 1))) && encode(value) == i ? 0.0 : 1.0;
    });
    run.add(exactCheck("table1", std::string("floatFrom") + name, "division in double, rounded once", "all codes, and back"), roundTrip,
            "code = " + exactText(roundTrip.input[0]));

    // c (2^n - 1) + 1/2 is itself rounded to float: an input next to an edge may fall on its other side.
    const auto error = [&](float x) {
        if (!(x > 0.0f)) return encode(x) == 0 ? 0.0 : 1.0;
        const double exact = std::min(double(x), 1.0) * (codes - 1);
        return std::max(0.0, std::abs(double(encode(x)) - exact) - 0.5);
    };
    auto edges = exhaust(std::uint64_t(codes) * 7u, [&](std::uint64_t i) {
        return error(moveByUlps(static_cast<float>((double(i / 7) + 0.5) / (codes - 1)), static_cast<std::int64_t>(i % 7) - 3));
    });
    const SearchSpace<float, 1> everywhere{{{{-2.0f, 3.0f}}}, {{0.0f}, {1.0f}, {-1.0f}}};
    const auto random = findWorst(
        everywhere, run.budget(100000), [&](const auto& in) { return error(in[0]); }, 202);
    const auto at = static_cast<std::uint64_t>(std::max(0.0, edges.input[0]));
    const float worstInput = random.error > edges.error
                                 ? random.input[0]
                                 : moveByUlps(static_cast<float>((double(at / 7) + 0.5) / (codes - 1)), static_cast<std::int64_t>(at % 7) - 3);
    edges.include(Worst<double, 1>{{0.0}, random.error, random.sum, random.swept, random.evaluations});
    run.add({.equation = "table1",
             .function = std::string(name) + "FromFloat",
             .oracle = "scaling in double",
             .domain = "7 floats about each of the edges; [-2, 3]",
             .errorKind = "codes beyond one half",
             .bound = {slackName, slack},
             .nanoseconds = run.time(4096, [&](std::size_t i) { return encode(float(i) / 4096.0f); })},
            edges, "x = " + exactText(worstInput));
}

}  // namespace

void checkFormats(CheckRun& run)
{
    checkHalf(run);
    checkUnorm(run, "Unorm16", 65536, kUnorm16EdgeError, "kUnorm16EdgeError", unorm16FromFloat,
               [](std::uint64_t i) { return floatFromUnorm16(std::uint16_t(i)); });
    checkUnorm(run, "Unorm8", 256, kUnorm8EdgeError, "kUnorm8EdgeError", unorm8FromFloat, [](std::uint64_t i) { return floatFromUnorm8(std::uint8_t(i)); });
}

}  // namespace lrsm
