#pragma once

#include "apps/sweep/axes.h"
#include "apps/sweep/front.h"
#include "core/settings/settings.h"

#include <optional>
#include <string>
#include <vector>

/// The grid that the front search walks on, and what is predicted of a point before it is rendered.
namespace lrsm {

/// Index of the value on each axis.
using GridPosition = std::vector<int>;

class SettingsGrid {
  public:
    /// Throws InputError for an axis without values, two axes of one key, and values that `applySetting` refuses.
    SettingsGrid(const Settings& base, std::vector<Axis> axes);

    /// Nothing where `validate` refuses the combination.
    std::optional<Settings> at(const GridPosition& position) const;
    /// The values that `settings` has, the origin's where it has none of an axis.
    GridPosition nearest(const Settings& settings) const;
    bool holds(const Settings& settings) const;
    /// The base, or the middle of the axes that do not hold its value.
    const GridPosition& origin() const { return origin_; }
    /// "key=value key=value" against the base; "base" for itself.
    std::string label(const Settings& settings) const;

    std::size_t axisCount() const { return axes_.size(); }
    int valueCount(std::size_t axis) const { return int(axes_[axis].values.size()); }
    double size() const;
    GridPosition first() const { return GridPosition(axes_.size(), 0); }
    /// To the next of all positions; false after the last.
    bool advance(GridPosition& position) const;

  private:
    Settings base_;
    std::vector<Axis> axes_;
    GridPosition origin_;
};

/// What a point visited on the grid brought.
struct GridPoint {
    GridPosition position;
    CostError value;
};

/// The mean effect of each axis step, in logarithms, from visited points that differ on one axis alone.
class StepEffects {
  public:
    StepEffects(const SettingsGrid& grid, const std::vector<GridPoint>& points);
    /// In natural logarithms of cost and error: the nearest visited point and the steps from it. Nothing without points.
    std::optional<CostError> predictLog(const std::vector<GridPoint>& points, const GridPosition& position) const;

  private:
    std::vector<std::vector<CostError>> effects_;  ///< [axis][step from value i to i + 1]
};

/// By how much, in logarithms, a point would have to worsen in both cost and error before one of the front beats it; negative: how much it falls short.
double gainOverFront(const std::vector<CostError>& front, const CostError& logPoint);

}  // namespace lrsm
