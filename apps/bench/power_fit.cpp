#include "apps/bench/power_fit.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace lrsm {
namespace {

bool fittable(std::span<const double> x, std::span<const double> t, std::size_t differentX)
{
    if (x.size() != t.size()) return false;
    const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
    if (!std::all_of(x.begin(), x.end(), positive) || !std::all_of(t.begin(), t.end(), positive)) return false;
    return std::set<double>(x.begin(), x.end()).size() >= differentX;
}

/// Of the relative residuals of t = a + b u, that is of 1 = a / t + b u / t.
struct LinearFit {
    double a = 0.0, b = 0.0, squares = 0.0;
};

double squaresOf(std::span<const double> u, std::span<const double> t, double a, double b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < t.size(); ++i) {
        const double off = (a + b * u[i]) / t[i] - 1.0;
        sum += off * off;
    }
    return sum;
}

/// Least squares with a, b >= 0: the free solution where it is allowed, else the better of the two borders.
LinearFit fitNonNegative(std::span<const double> u, std::span<const double> t)
{
    double ff = 0.0, fg = 0.0, gg = 0.0, f1 = 0.0, g1 = 0.0;
    for (std::size_t i = 0; i < t.size(); ++i) {
        const double f = 1.0 / t[i], g = u[i] / t[i];
        ff += f * f;
        fg += f * g;
        gg += g * g;
        f1 += f;
        g1 += g;
    }
    const double determinant = ff * gg - fg * fg;
    if (determinant > 1e-12 * ff * gg) {
        const double a = (f1 * gg - g1 * fg) / determinant, b = (g1 * ff - f1 * fg) / determinant;
        if (a >= 0.0 && b >= 0.0) return {a, b, squaresOf(u, t, a, b)};
    }
    const LinearFit flat{f1 / ff, 0.0, squaresOf(u, t, f1 / ff, 0.0)}, bare{0.0, g1 / gg, squaresOf(u, t, 0.0, g1 / gg)};
    return flat.squares <= bare.squares ? flat : bare;
}

LinearFit fitWithExponent(std::span<const double> x, std::span<const double> t, double largest, double exponent)
{
    std::vector<double> u;
    for (const double value : x) u.push_back(std::pow(value / largest, exponent));
    return fitNonNegative(u, t);
}

}  // namespace

double PowerFit::at(double x) const
{
    return coefficient * std::pow(x, exponent);
}

double OffsetFit::at(double x) const
{
    return constant + factor * std::pow(x, exponent);
}

std::optional<PowerFit> fitPower(std::span<const double> x, std::span<const double> t)
{
    if (!fittable(x, t, 2)) return {};
    const double n = static_cast<double>(x.size());
    double meanX = 0.0, meanT = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        meanX += std::log(x[i]) / n;
        meanT += std::log(t[i]) / n;
    }
    double xx = 0.0, xt = 0.0, tt = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double dx = std::log(x[i]) - meanX, dt = std::log(t[i]) - meanT;
        xx += dx * dx;
        xt += dx * dt;
        tt += dt * dt;
    }
    PowerFit fit;
    fit.exponent = xt / xx;
    fit.coefficient = std::exp(meanT - fit.exponent * meanX);
    const double rest = std::max(0.0, tt - fit.exponent * xt);
    if (x.size() > 2) fit.standardError = std::sqrt(rest / (n - 2.0) / xx);
    if (tt > 1e-24 * n) fit.r2 = 1.0 - rest / tt;
    return fit;
}

std::optional<OffsetFit> fitOffsetPower(std::span<const double> x, std::span<const double> t)
{
    if (!fittable(x, t, 4)) return {};
    const double largest = *std::max_element(x.begin(), x.end());
    const auto squares = [&](double exponent) { return fitWithExponent(x, t, largest, exponent).squares; };

    // The valley may have more than one dip: a grid finds the deepest, golden sections its bottom.
    constexpr double kGrid = 0.05;
    double best = kOffsetExponentMin;
    for (int i = 1; kOffsetExponentMin + i * kGrid <= kOffsetExponentMax + 1e-9; ++i) {
        const double exponent = kOffsetExponentMin + i * kGrid;
        if (squares(exponent) < squares(best)) best = exponent;
    }
    constexpr double kGolden = 0.6180339887498949;
    double low = best - kGrid, high = best + kGrid;
    for (int i = 0; i < 40; ++i) {
        const double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
        (squares(left) < squares(right) ? high : low) = squares(left) < squares(right) ? right : left;
    }
    const double exponent = std::clamp(0.5 * (low + high), kOffsetExponentMin, kOffsetExponentMax);

    const LinearFit linear = fitWithExponent(x, t, largest, exponent);
    OffsetFit fit{linear.a, linear.b * std::pow(largest, -exponent), exponent, std::sqrt(linear.squares / static_cast<double>(x.size()))};
    if (linear.b == 0.0) fit.exponent = 0.0;
    return fit;
}

}  // namespace lrsm
