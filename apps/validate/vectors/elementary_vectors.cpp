// The elementary functions that every equation stands on: core/base/elementary.h.
#include "apps/validate/equations/oracle.h"
#include "apps/validate/vectors/make_vectors.h"
#include "apps/validate/vectors/set_parts.h"
#include "core/base/elementary.h"

namespace lrsm {
namespace {

/// What rounding the exact result to double takes, relative.
constexpr double kRounding = 0x1p-53;

/// The exact result, from how far `value` is off.
double exactFromError(double value, double error)
{
    return value - error;
}
double exactFromRelativeError(double value, double error)
{
    return value / (1.0 + error);
}

/// A function of one number. `evaluate` gives the result for each output.
template <class T, class Evaluate>
void addFunction(std::vector<VectorSet>& sets, std::vector<VectorOutput> outputs, const std::string& argument, const SearchSpace<T, 1>& space,
                 const Evaluate& evaluate, std::uint32_t stream)
{
    const Dtype dtype = sizeof(T) == 8 ? Dtype::f8 : Dtype::f4;
    for (VectorOutput& output : outputs) output.exact.dtype = dtype;
    const VectorArray& first = outputs.front().exact;
    VectorSet& set = sets.emplace_back(VectorSet{.name = first.name.substr(first.name.find('.') + 1),
                                                 .meaning = first.meaning,
                                                 .inputs = {{argument, {}, "", "", dtype}},
                                                 .outputs = outputs,
                                                 .kinds = {}});
    fillSet(set, space,
            [&](const std::array<T, 1>& in) {
                return VectorCase{{{double(in[0])}}, evaluate(in[0])};
            },
            stream, {.typical = 128, .worst = 32, .search = 600});
}

void addFloats(std::vector<VectorSet>& sets)
{
    SearchSpace<float, 1> logarithms{{{{0x1p-126f, 0x1p127f, Spacing::logarithmic}}}, {{0.70710678f}, {1.41421356f}, {1.0f}, {0.5f}, {2.0f}}};
    for (const int ulps : {-3, -2, -1, 1, 2, 3}) logarithms.planted.push_back({moveByUlps(1.0f, ulps)});
    addFunction(
        sets,
        {outputOf("base", {"base.log2", {}, "", "log2(x), float32"}, {"kFastLog2MaxError", double(kFastLog2MaxError)}, "absolute, and |log2 x| 2^-24"),
         outputOf("base", {"base.log2_gpu", {}, "", "log2(x) as D3D11.3 asks it of a GPU"}, kGpuMaxError, "absolute / max(1, |log2 x|)")},
        "x", logarithms,
        [](float x) {
            const double exact = -oracle::log2Error(double(x), 0.0), ours = double(fastLog2(x));
            return std::vector<VectorResult>{single(exact, double(kFastLog2MaxError) + std::abs(exact) * kHalfUlp, ours),
                                             single(exact, kGpuMaxError.value * std::max(1.0, std::abs(exact)), ours)};
        },
        1700);
    addFunction(
        sets,
        {outputOf("base", {"base.exp2", {}, "", "2^x, float32"}, {"kFastExp2MaxError", double(kFastExp2MaxError)}, "relative"),
         outputOf("base", {"base.exp2_gpu", {}, "", "2^x as D3D11.3 asks it of a GPU"}, kGpuMaxError, "relative")},
        "x", SearchSpace<float, 1>{{{{-126.0f, 127.0f}}}, {{0.0f}, {0.5f}, {-0.5f}, {1.0f}, {-1.0f}, {126.5f}}},
        [](float x) {
            const double ours = double(fastExp2(x)), exact = exactFromRelativeError(ours, oracle::exp2RelativeError(double(x), ours));
            return std::vector<VectorResult>{single(exact, double(kFastExp2MaxError) * exact, ours), single(exact, kGpuMaxError.value * exact, ours)};
        },
        1710);
}

void addDoubles(std::vector<VectorSet>& sets)
{
    addFunction(
        sets, {outputOf("base", {"base.log2_double", {}, "", "log2(x), float64"}, {"kLog2MaxError", kLog2MaxError}, "absolute / max(1, |log2 x|)")}, "x",
        SearchSpace<double, 1>{{{{0x1p-1000, 0x1p1000, Spacing::logarithmic}}},
                               {{0.70710678118654752440}, {1.0}, {0.5}, {2.0}, {1.0 + 0x1p-52}, {1.0 - 0x1p-53}}},
        [](double x) {
            const double exact = -oracle::log2Error(x, 0.0);
            return std::vector<VectorResult>{single(exact, kLog2MaxError * std::max(1.0, std::abs(exact)) + kRounding * std::abs(exact), log2Exact(x))};
        },
        1720);
    addFunction(
        sets, {outputOf("base", {"base.exp2_double", {}, "", "2^x, float64"}, {"kExp2MaxError", kExp2MaxError}, "relative")}, "x",
        SearchSpace<double, 1>{{{{-1000.0, 1000.0}}}, {{0.5}, {-0.5}, {0.0}, {1.5}, {-999.5}, {999.5}}},
        [](double x) {
            const double ours = exp2Exact(x), exact = exactFromRelativeError(ours, oracle::exp2RelativeError(x, ours));
            return std::vector<VectorResult>{single(exact, (kExp2MaxError + 2.0 * kRounding) * exact, ours)};
        },
        1730);
    const SearchSpace<double, 1> angles{{{{1e-9, 1e6, Spacing::signedLogarithmic}}},
                                        {{0.78539816339744831}, {1.5707963267948966}, {3.1415926535897932}, {999999.5}}};
    addFunction(
        sets, {outputOf("base", {"base.sin", {}, "", "sin of an angle in radians, float64"}, {"kSinCosMaxError", kSinCosMaxError})}, "angle", angles,
        [](double x) {
            const double ours = sinCos(x).sin;
            return std::vector<VectorResult>{single(exactFromError(ours, oracle::sinError(x, ours)), kSinCosMaxError + kRounding, ours)};
        },
        1740);
    addFunction(
        sets, {outputOf("base", {"base.cos", {}, "", "cos of an angle in radians, float64"}, {"kSinCosMaxError", kSinCosMaxError})}, "angle", angles,
        [](double x) {
            const double ours = sinCos(x).cos;
            return std::vector<VectorResult>{single(exactFromError(ours, oracle::cosError(x, ours)), kSinCosMaxError + kRounding, ours)};
        },
        1750);
}

/// Functions of two numbers.
void addPairs(std::vector<VectorSet>& sets)
{
    VectorSet& angle =
        sets.emplace_back(VectorSet{.name = "arc_tangent",
                                    .meaning = "atan2(y, x), float64",
                                    .inputs = {{"y", {}, "", "", Dtype::f8}, {"x", {}, "", "", Dtype::f8}},
                                    .outputs = {outputOf("base", {"base.atan2", {}, "rad", "angle of (x, y) from the x axis, in [-pi, pi]", Dtype::f8},
                                                         {"kArcTangentMaxError", kArcTangentMaxError})},
                                    .kinds = {}});
    fillSet(angle,
            SearchSpace<double, 2>{{{{1e-9, 1e9, Spacing::signedLogarithmic}, {0.5, 2.0, Spacing::signedLogarithmic}}}, {{1.0, 1.0}, {-1.0, -1.0}, {0.0, 1.0}}},
            [](const std::array<double, 2>& in) {
                const double ours = arcTangent2(in[0], in[1]);
                return VectorCase{{{in[0]}, {in[1]}},
                                  {single(exactFromError(ours, oracle::arcTangent2Error(in[0], in[1], ours)), kArcTangentMaxError + 4.0 * kRounding, ours)}};
            },
            1760, {.typical = 128, .worst = 32, .search = 600});

    VectorSet& powers =
        sets.emplace_back(VectorSet{.name = "power",
                                    .meaning = "x^y, float64",
                                    .inputs = {{"x", {}, "", "", Dtype::f8}, {"y", {}, "", "", Dtype::f8}},
                                    .outputs = {outputOf("base", {"base.power", {}, "", "x^y", Dtype::f8}, {"kPowerMaxError", kPowerMaxError}, "relative")},
                                    .kinds = {}});
    fillSet(powers, SearchSpace<double, 2>{{{{1e-6, 1e6, Spacing::logarithmic}, {-5.0, 5.0}}}, {{1.0, 2.4}, {0.5, 2.0}}},
            [](const std::array<double, 2>& in) {
                const double ours = power(in[0], in[1]), exact = exactFromRelativeError(ours, oracle::powerRelativeError(in[0], in[1], ours));
                return VectorCase{{{in[0]}, {in[1]}}, {single(exact, (kPowerMaxError + 2.0 * kRounding) * exact, ours)}};
            },
            1770, {.typical = 128, .worst = 32, .search = 600});
}

}  // namespace

void addElementaryVectors(std::vector<VectorSet>& sets)
{
    addFloats(sets);
    addDoubles(sets);
    addPairs(sets);
}

}  // namespace lrsm
