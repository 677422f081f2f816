#pragma once

#include <optional>
#include <span>

/// How a cost grows with a size: least squares of power laws. Sizes and costs must be positive and finite.
namespace lrsm {

/// log t = log coefficient + exponent log x, each point with the same relative weight.
struct PowerFit {
    double coefficient = 0.0, exponent = 0.0;
    double standardError = 0.0;  ///< of the exponent, from the residuals; 0 with two points
    double r2 = 1.0;             ///< share of the variance of log t that the line explains; 1 where t is constant
    double at(double x) const;
};
/// Nothing where a value is not positive and finite, or where there are fewer than two different x.
std::optional<PowerFit> fitPower(std::span<const double> x, std::span<const double> t);

/// t = constant + factor x^exponent: what does not grow is kept apart from what does. constant, factor >= 0.
struct OffsetFit {
    double constant = 0.0, factor = 0.0, exponent = 0.0;
    double residual = 0.0;  ///< root mean square of the relative residuals
    double at(double x) const;
    /// Of the cost at x, what does not grow.
    double constantShare(double x) const { return constant / at(x); }
};
inline constexpr double kOffsetExponentMin = -2.0, kOffsetExponentMax = 4.0;
/// Least relative squares: linear in constant and factor for a given exponent, which is searched for in [-2, 4]. Nothing with fewer than four
/// different x (three unknowns), or where a value is not positive and finite. A constant t gives factor 0, exponent 0.
std::optional<OffsetFit> fitOffsetPower(std::span<const double> x, std::span<const double> t);

}  // namespace lrsm
