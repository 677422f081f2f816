#include "apps/sweep/relative.h"

#include "core/base/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lrsm {

namespace {

constexpr double kLeastError = 1e-6;

}  // namespace

CostError relativeTo(const Measurement& row, const Measurement& baseline)
{
    return {row.cost / baseline.cost, std::max(row.error.net(), kLeastError) / std::max(baseline.error.net(), kLeastError)};
}

CostError combineScenes(std::span<const CostError> scenes)
{
    if (scenes.empty()) return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    CostError sum;
    for (const CostError& scene : scenes) {
        sum.cost += std::log(scene.cost);
        sum.error += std::log(scene.error);
    }
    const double count = double(scenes.size());
    return {std::exp(sum.cost / count), std::exp(sum.error / count)};
}

CostError combineScenes(const std::vector<Measurement>& rows, const std::vector<Measurement>& baselines)
{
    std::vector<CostError> scenes;
    for (const Measurement& row : rows) {
        const auto baseline = std::find_if(baselines.begin(), baselines.end(), [&](const Measurement& other) { return other.caseKey == row.caseKey; });
        if (baseline == baselines.end()) throw InputError("row " + row.key, "no baseline was measured for its case " + row.caseKey + " (" + row.scene + ")");
        scenes.push_back(relativeTo(row, *baseline));
    }
    return combineScenes(scenes);
}

double geometricMean(const std::vector<double>& values)
{
    double sum = 0.0;
    for (const double value : values) sum += std::log(value);
    return values.empty() ? 1.0 : std::exp(sum / static_cast<double>(values.size()));
}

}  // namespace lrsm
