#pragma once

#include <cstddef>
#include <optional>
#include <vector>

/// Pareto fronts of cost against error; both are better when smaller.
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

}  // namespace lrsm
