#include "apps/sweep/search_grid.h"

#include "core/base/errors.h"
#include "core/base/text.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace lrsm {

namespace {

void applyValue(Settings& settings, const Axis& axis, int index)
{
    applySetting(settings, axis.key + "=" + axis.values[std::size_t(index)]);
}

/// A logarithm that exact pictures survive.
double safeLog(double value)
{
    return std::log(std::max(value, 1e-12));
}

int distance(const GridPosition& a, const GridPosition& b)
{
    int sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
    return sum;
}

}  // namespace

SettingsGrid::SettingsGrid(const Settings& base, std::vector<Axis> axes) : base_(base), axes_(std::move(axes))
{
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        if (axes_[i].values.empty()) throw InputError("axis " + axes_[i].key, "has no values");
        for (std::size_t j = 0; j < i; ++j)
            if (axes_[j].key == axes_[i].key) throw InputError("axis " + axes_[i].key, "is there twice; name all its values once");
        // The middle until the base's own value is found.
        int chosen = valueCount(i) / 2;
        for (int value = 0; value < valueCount(i); ++value) {
            Settings changed = base_;
            applyValue(changed, axes_[i], value);
            if (changed == base_) chosen = value;
        }
        origin_.push_back(chosen);
    }
}

std::optional<Settings> SettingsGrid::at(const GridPosition& position) const
{
    Settings settings = base_;
    for (std::size_t i = 0; i < axes_.size(); ++i) applyValue(settings, axes_[i], position[i]);
    try {
        validate(settings);
    } catch (const InputError&) {
        return {};
    }
    return settings;
}

GridPosition SettingsGrid::nearest(const Settings& settings) const
{
    GridPosition position = origin_;
    for (std::size_t i = 0; i < axes_.size(); ++i)
        for (int value = 0; value < valueCount(i); ++value) {
            Settings changed = settings;
            applyValue(changed, axes_[i], value);
            if (changed == settings) position[i] = value;
        }
    return position;
}

bool SettingsGrid::holds(const Settings& settings) const
{
    const std::optional<Settings> there = at(nearest(settings));
    return there && *there == settings;
}

std::string SettingsGrid::label(const Settings& settings) const
{
    const std::vector<SettingDifference> changes = differences(base_, settings);
    return changes.empty() ? "base"
                           : joined(
                                 changes, [](const SettingDifference& change) { return change.key + "=" + change.b; }, " ");
}

double SettingsGrid::size() const
{
    double product = 1.0;
    for (std::size_t i = 0; i < axes_.size(); ++i) product *= valueCount(i);
    return product;
}

bool SettingsGrid::advance(GridPosition& position) const
{
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        if (++position[i] < valueCount(i)) return true;
        position[i] = 0;
    }
    return false;
}

StepEffects::StepEffects(const SettingsGrid& grid, const std::vector<GridPoint>& points)
{
    struct Sum {
        CostError total;
        int count = 0;
    };
    const auto meanOf = [](const Sum& sum) { return CostError{sum.total.cost / sum.count, sum.total.error / sum.count}; };

    for (std::size_t axis = 0; axis < grid.axisCount(); ++axis) {
        std::vector<Sum> steps(std::size_t(grid.valueCount(axis)));
        Sum all;
        for (const GridPoint& a : points)
            for (const GridPoint& b : points) {
                const int jump = b.position[axis] - a.position[axis];
                if (jump <= 0 || distance(a.position, b.position) != jump) continue;
                // A jump over several values is shared out evenly.
                const CostError each{(safeLog(b.value.cost) - safeLog(a.value.cost)) / jump, (safeLog(b.value.error) - safeLog(a.value.error)) / jump};
                for (int i = a.position[axis]; i < b.position[axis]; ++i)
                    for (Sum* sum : {&steps[std::size_t(i)], &all}) {
                        sum->total.cost += each.cost;
                        sum->total.error += each.error;
                        ++sum->count;
                    }
            }
        // A step that was never taken is like the others of its axis; of an axis never moved, only its order is known.
        const CostError unknown = all.count > 0 ? meanOf(all) : CostError{0.1, -0.1};
        std::vector<CostError> effects;
        for (const Sum& sum : steps) effects.push_back(sum.count > 0 ? meanOf(sum) : unknown);
        effects_.push_back(std::move(effects));
    }
}

std::optional<CostError> StepEffects::predictLog(const std::vector<GridPoint>& points, const GridPosition& position) const
{
    const GridPoint* nearest = nullptr;
    for (const GridPoint& point : points)
        if (!nearest || distance(point.position, position) < distance(nearest->position, position)) nearest = &point;
    if (!nearest) return {};

    CostError value{safeLog(nearest->value.cost), safeLog(nearest->value.error)};
    for (std::size_t axis = 0; axis < position.size(); ++axis) {
        const int from = nearest->position[axis], to = position[axis];
        const double sign = to > from ? 1.0 : -1.0;
        for (int i = std::min(from, to); i < std::max(from, to); ++i) {
            value.cost += sign * effects_[axis][std::size_t(i)].cost;
            value.error += sign * effects_[axis][std::size_t(i)].error;
        }
    }
    return value;
}

double gainOverFront(const std::vector<CostError>& front, const CostError& logPoint)
{
    double gain = std::numeric_limits<double>::infinity();
    for (const CostError& point : front) gain = std::min(gain, std::max(safeLog(point.cost) - logPoint.cost, safeLog(point.error) - logPoint.error));
    return gain;
}

}  // namespace lrsm
