// The elementary functions that every equation stands on: core/base/elementary.h.
#include "core/base/elementary.h"

#include "apps/validate/equations/check_run.h"
#include "apps/validate/equations/oracle.h"

namespace lrsm {
namespace {

/// fastLog2 over every mantissa of an octave, at an exponent that changes with it; powers of two must be exact.
void checkFastLog2(CheckRun& run)
{
    const auto stride = std::max<std::uint64_t>(1, 0x800000u / run.scaled(0x800000u, 60000.0)) | 1u;
    const auto valueAt = [](std::uint64_t i) {
        const auto exponent = static_cast<std::uint32_t>(1 + (i * 2654435761u >> 7) % 254);
        return std::bit_cast<float>(static_cast<std::uint32_t>(i) | exponent << 23);
    };
    const auto error = [](float x) {
        const auto exact = static_cast<double>(std::log2(static_cast<long double>(x)));
        return std::max(0.0, std::abs(double(fastLog2(x)) - exact) - std::abs(exact) * 0x1p-24);
    };
    auto worst = exhaust(
        0x800000u, [&](std::uint64_t i) { return error(valueAt(i)); }, stride);
    float worstInput = valueAt(static_cast<std::uint64_t>(std::max(0.0, worst.input[0])));
    // The octaves next to 1, where nothing hides behind the result's own rounding.
    const SearchSpace<float, 1> space{{{{0.5f, 2.0f}}}, {{0.70710678f}, {1.41421356f}, {1.0f}, {0.5f}, {2.0f}}};
    const auto near = findWorst(
        space, run.budget(400000), [&](const auto& in) { return error(in[0]); }, 101);
    if (near.error > worst.error) worstInput = near.input[0];
    worst.include(Worst<double, 1>{{0.0}, near.error, near.sum, near.swept, near.evaluations});
    run.add({.equation = "base",
             .function = "fastLog2",
             .oracle = "log2 in long double",
             .domain = "every mantissa, all normal exponents",
             .errorKind = "absolute, beyond |log2 x| 2^-24",
             .bound = {"kFastLog2MaxError", double(kFastLog2MaxError)},
             .nanoseconds = run.time(4096, [](std::size_t i) { return fastLog2(0.25f + float(i)); })},
            worst, "x = " + exactText(worstInput));

    const auto powers = exhaust(254, [](std::uint64_t i) { return fastLog2(std::ldexp(1.0f, int(i) - 126)) == float(int(i) - 126) ? 0.0 : 1.0; });
    run.add(exactCheck("base", "fastLog2, powers of two", "the exponent", "2^-126 .. 2^127"), powers, "x = 2^(i - 126), i = " + exactText(powers.input[0]));
}

void checkFastExp2(CheckRun& run)
{
    SearchSpace<float, 1> space{{{{-126.0f, 127.999f}}}, {}};
    for (int i = -126; i < 128; ++i) space.planted.insert(space.planted.end(), {{float(i)}, {float(i) - 0.5f}});
    const auto error = [](const std::array<float, 1>& in) {
        const long double exact = std::exp2(static_cast<long double>(std::max(in[0], -126.0f)));
        return static_cast<double>(std::abs((static_cast<long double>(fastExp2(in[0])) - exact) / exact));
    };
    auto worst = findWorst(space, run.budget(1000000), error, 102);
    run.add({.equation = "base",
             .function = "fastExp2",
             .oracle = "exp2 in long double",
             .domain = "[-126, 128)",
             .errorKind = "relative",
             .bound = {"kFastExp2MaxError", double(kFastExp2MaxError)},
             .nanoseconds = run.time(4096, [](std::size_t i) { return fastExp2(-float(i) * 0.01f); })},
            worst, inputText<float, 1>({"x"}, worst.input));

    const auto edges = exhaust(254 + 6, [](std::uint64_t i) {
        if (i < 254) return fastExp2(float(int(i) - 126)) == std::ldexp(1.0f, int(i) - 126) ? 0.0 : 1.0;
        constexpr float kBelow[3] = {-126.00001f, -200.0f, -std::numeric_limits<float>::infinity()},
                        kAbove[3] = {128.0f, 1e30f, std::numeric_limits<float>::infinity()};
        return i < 257 ? (fastExp2(kBelow[i - 254]) == 0.0f ? 0.0 : 1.0) : (std::isinf(fastExp2(kAbove[i - 257])) ? 0.0 : 1.0);
    });
    run.add(exactCheck("base", "fastExp2, whole numbers and saturation", "ldexp", "-126 .. 127; beyond: 0, infinity"), edges,
            "case " + exactText(edges.input[0]));
}

/// One double function against 50 digits. The search itself runs on these, at some 20 us a call.
template <class Error>
void addExact(CheckRun& run, EquationCheck check, const SearchSpace<double, 1>& space, double calls, const Error& error, std::uint32_t stream)
{
    check.equation = "base";
    check.oracle = "50 digits (Boost.Multiprecision)";
    const auto worst = findWorst(
        space, run.budget(calls), [&](const auto& in) { return error(in[0]); }, stream);
    run.add(std::move(check), worst, inputText<double, 1>({"x"}, worst.input));
}

void checkExact(CheckRun& run)
{
    addExact(
        run,
        {.function = "log2Exact",
         .domain = "2^-1000 .. 2^1000, and [1/2, 2]",
         .errorKind = "absolute / max(1, |log2 x|)",
         .bound = {"kLog2MaxError", kLog2MaxError}},
        {{{{0x1p-1000, 0x1p1000, Spacing::logarithmic}}}, {{0.70710678118654752440}, {1.0}, {0.5}, {2.0}, {1.41421356237309504880}}}, 4000,
        [](double x) {
            // Both the wide range and, folded, the octaves about 1 where the series alone speaks.
            const double folded = std::ldexp(std::frexp(x, std::array<int, 1>{}.data()), (static_cast<int>(std::bit_cast<std::uint64_t>(x) & 1u)));
            const auto scaled = [](double v) {
                const double e = log2Exact(v);
                return std::abs(oracle::log2Error(v, e)) / std::max(1.0, std::abs(e));
            };
            return std::max(scaled(x), scaled(folded));
        },
        111);
    addExact(
        run, {.function = "exp2Exact", .domain = "[-1000, 1000]", .errorKind = "relative", .bound = {"kExp2MaxError", kExp2MaxError}},
        {{{{-1000.0, 1000.0}}}, {{0.5}, {-0.5}, {0.0}, {1.5}, {-999.5}, {999.5}}}, 3000,
        [](double x) { return std::abs(oracle::exp2RelativeError(x, exp2Exact(x))); }, 112);
    addExact(
        run, {.function = "sinCos", .domain = "|angle| <= 1e6", .bound = {"kSinCosMaxError", kSinCosMaxError}},
        {{{{1e-9, 1e6, Spacing::signedLogarithmic}}}, {{0.78539816339744831}, {1.5707963267948966}, {3.1415926535897932}, {1e6}, {999999.5}}}, 4000,
        [](double x) {
            const SinCos sc = sinCos(x);
            return std::max(std::abs(oracle::sinError(x, sc.sin)), std::abs(oracle::cosError(x, sc.cos)));
        },
        113);
    addExact(
        run, {.function = "arcTangent2", .domain = "y / x of 1e-9 .. 1e9, all quadrants", .bound = {"kArcTangentMaxError", kArcTangentMaxError}},
        {{{{1e-9, 1e9, Spacing::signedLogarithmic}}}, {{1.0}, {-1.0}, {0.41421356237309503}}}, 4000,
        [](double y) {
            const double x = (std::bit_cast<std::uint64_t>(y) & 1u) ? 1.0 : -1.0;
            return std::abs(oracle::arcTangent2Error(y, x, arcTangent2(y, x)));
        },
        114);
    const SearchSpace<double, 2> powers{{{{1e-6, 1e6, Spacing::logarithmic}, {-5.0, 5.0}}}, {{1.0, 2.4}, {0.5, 2.0}}};
    const auto worst = findWorst(
        powers, run.budget(1500), [](const auto& in) { return std::abs(oracle::powerRelativeError(in[0], in[1], power(in[0], in[1]))); }, 115);
    run.add({.equation = "base",
             .function = "power",
             .oracle = "50 digits (Boost.Multiprecision)",
             .domain = "1e-6 .. 1e6, exponents -5 .. 5",
             .errorKind = "relative",
             .bound = {"kPowerMaxError", kPowerMaxError}},
            worst, inputText<double, 2>({"x", "y"}, worst.input));
}

}  // namespace

void checkElementary(CheckRun& run)
{
    checkFastLog2(run);
    checkFastExp2(run);
    checkExact(run);
}

}  // namespace lrsm
