#pragma once

#include "apps/validate/equations/check_equations.h"
#include "apps/validate/vectors/pick_cases.h"
#include "core/base/math.h"
#include "core/report/table.h"

#include <utility>

/// What the groups of sets are written with.
namespace lrsm {

/// 2^-24: half an ULP of float32, relative.
inline constexpr double kHalfUlp = 0x1p-24;

/// What D3D11.3 asks of a GPU's log2 and exp2.
inline constexpr NamedBound kGpuMaxError{"2^-21", 0x1p-21};

inline VectorOutput outputOf(const std::string& equation, VectorArray array, const NamedBound& bound, const std::string& kind = "absolute")
{
    return {.equation = equation,
            .exact = std::move(array),
            .bound = std::string(bound.name) + " = " + shortNumber(bound.value) + ", " + kind,
            .allowed = {},
            .ours = {}};
}

inline std::vector<double> wide(const Vec3& v)
{
    return {double(v.x), double(v.y), double(v.z)};
}
inline std::vector<double> wide(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}

/// A result that is a number.
inline VectorResult single(double exact, double allowed, double ours)
{
    return {{exact}, {allowed}, {ours}};
}
/// One whose entries are all allowed the same.
inline VectorResult many(std::vector<double> exact, double allowed, std::vector<double> ours)
{
    const std::size_t count = exact.size();
    return {std::move(exact), std::vector<double>(count, allowed), std::move(ours)};
}
/// Where the program has no float function of its own: the exact result as float32 stands for it.
inline VectorResult rounded(std::vector<double> exact, double allowed)
{
    std::vector<double> ours;
    for (const double value : exact) ours.push_back(double(static_cast<float>(value)));
    return many(std::move(exact), allowed, std::move(ours));
}

/// For sets whose cases are drawn whole: the point is the draw's number, those below `specials` are made by hand.
inline SearchSpace<float, 1> draws(int specials)
{
    SearchSpace<float, 1> space{{{{float(specials), 1e6f}}}, {}};
    for (int i = 0; i < specials; ++i) space.planted.push_back({float(i)});
    return space;
}
/// Draws cost more than they tell a search.
inline constexpr CaseCounts kDrawCounts{.typical = 96, .worst = 16, .search = 300};

}  // namespace lrsm
