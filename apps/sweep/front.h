#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

/// Cost against error, both better when smaller: Pareto fronts, curves, and means over scenes.
namespace lrsm {

struct CostError {
    double cost = 0.0, error = 0.0;
};

/// Indices of the points that no other point beats (none is at most equal in both and smaller in one), by rising cost; of equal points the
/// first stays. Points with a NaN are never on it.
std::vector<std::size_t> paretoFront(const std::vector<CostError>& points);

/// Cost at which a curve of points sorted by cost reaches `error`, interpolated in log-log between neighbours; nothing when it never does.
std::optional<double> costAtError(const std::vector<CostError>& curve, double error);
/// Error that the curve reaches at `cost`; nothing before its first point. Beyond its last point: the last error.
std::optional<double> errorAtCost(const std::vector<CostError>& curve, double cost);

/// Geometric means of cost and error over scenes, each relative to a baseline of its own: each scene counts alike, however dear or hard it is. NaN where
/// there is none, or where one of them is NaN.
CostError combineScenes(std::span<const CostError> scenes);
/// exp of the mean of logarithms; 1 for none. Of values > 0.
double geometricMean(const std::vector<double>& values);

}  // namespace lrsm
