#include "apps/sweep/front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lrsm {

std::vector<std::size_t> paretoFront(const std::vector<CostError>& points)
{
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!std::isnan(points[i].cost) && !std::isnan(points[i].error)) order.push_back(i);
    // By rising cost, then error: whatever beats a point stands before it.
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return points[a].cost != points[b].cost ? points[a].cost < points[b].cost : points[a].error < points[b].error;
    });
    std::vector<std::size_t> front;
    for (const std::size_t i : order)
        if (front.empty() || points[i].error < points[front.back()].error) front.push_back(i);
    return front;
}

namespace {

/// y at x on the straight line through two points in log-log; the second's y where logarithms have no meaning.
double alongLine(double x, double x0, double y0, double x1, double y1)
{
    if (!(x > 0.0 && x0 > 0.0 && x1 > 0.0 && y0 > 0.0 && y1 > 0.0) || x0 == x1) return y1;
    const double t = std::log(x / x0) / std::log(x1 / x0);
    return y0 * std::exp(t * std::log(y1 / y0));
}

}  // namespace

std::optional<double> costAtError(const std::vector<CostError>& curve, double error)
{
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (!(curve[i].error <= error)) continue;
        if (i == 0 || curve[i].error == error) return curve[i].cost;
        return alongLine(error, curve[i - 1].error, curve[i - 1].cost, curve[i].error, curve[i].cost);
    }
    return {};
}

std::optional<double> errorAtCost(const std::vector<CostError>& curve, double cost)
{
    if (curve.empty() || !(cost >= curve.front().cost)) return {};
    // The last point that is no dearer: of equal costs the last counts.
    std::size_t i = 0;
    while (i + 1 < curve.size() && curve[i + 1].cost <= cost) ++i;
    if (i + 1 == curve.size() || curve[i].cost == cost) return curve[i].error;
    return alongLine(cost, curve[i + 1].cost, curve[i + 1].error, curve[i].cost, curve[i].error);
}

CostError combineScenes(std::span<const CostError> scenes)
{
    if (scenes.empty()) return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    std::vector<double> costs, errors;
    for (const CostError& scene : scenes) {
        costs.push_back(scene.cost);
        errors.push_back(scene.error);
    }
    return {geometricMean(costs), geometricMean(errors)};
}

double geometricMean(const std::vector<double>& values)
{
    double sum = 0.0;
    for (const double value : values) sum += std::log(value);
    return values.empty() ? 1.0 : std::exp(sum / static_cast<double>(values.size()));
}

}  // namespace lrsm
