#include "apps/sweep/search.h"

#include "apps/sweep/search_grid.h"
#include "core/base/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <sstream>

namespace lrsm {

namespace {

class FrontSearch {
  public:
    FrontSearch(const Settings& base, const std::vector<Axis>& axes, const SearchOptions& options)
        : base_(base), options_(options), grid_(base, axes), random_(options.seed)
    {
    }

    SearchResult run()
    {
        visitStart();
        while (mayGoOn()) {
            const bool explore = options_.exploreEvery > 0 && result_.visited % options_.exploreEvery == options_.exploreEvery - 1;
            std::optional<GridPosition> next = explore ? drawn() : mostPromising();
            if (!next) next = explore ? mostPromising() : drawn();
            if (!next) next = anyLeft();
            if (!next) break;
            visit(*next, true);
        }
        result_.front = paretoFront(values());
        return std::move(result_);
    }

  private:
    bool mayGoOn(int reserved = 0) const { return !result_.stopped && result_.visited + reserved < options_.budget; }

    void visitStart()
    {
        for (const NamedSettings& named : options_.start) {
            if (!mayGoOn()) return;
            const bool onGrid = grid_.holds(named.settings);
            const GridPosition position = grid_.nearest(named.settings);
            if (onGrid && !seen_.insert(position).second) continue;
            visitSettings(named, onGrid ? &position : nullptr, false);
        }
        if (isNew(grid_.origin()) && mayGoOn()) visit(grid_.origin(), false);
        // Neighbours of all axes before the ends of any: half of a small budget must do.
        const auto move = [&](std::size_t axis, int value) {
            GridPosition position = grid_.origin();
            position[axis] = value;
            if (mayGoOn(options_.budget / 2) && isNew(position)) visit(position, true);
        };
        for (std::size_t axis = 0; axis < grid_.axisCount(); ++axis)
            for (const int step : {-1, 1}) move(axis, grid_.origin()[axis] + step);
        for (std::size_t axis = 0; axis < grid_.axisCount(); ++axis)
            for (const int end : {0, grid_.valueCount(axis) - 1}) move(axis, end);
    }

    /// Inside the grid, with a meaning, and not visited.
    bool isNew(const GridPosition& position)
    {
        for (std::size_t axis = 0; axis < position.size(); ++axis)
            if (position[axis] < 0 || position[axis] >= grid_.valueCount(axis)) return false;
        if (seen_.contains(position)) return false;
        if (!grid_.at(position)) {
            ++result_.refused;
            seen_.insert(position);
            return false;
        }
        return true;
    }

    void visit(const GridPosition& position, bool mayAbandon)
    {
        seen_.insert(position);
        const Settings settings = *grid_.at(position);
        visitSettings({settings == base_ ? "base" : grid_.label(settings), settings}, &position, mayAbandon);
    }

    void visitSettings(const NamedSettings& named, const GridPosition* position, bool mayAbandon)
    {
        if (options_.stop && options_.stop()) {
            result_.stopped = true;
            return;
        }
        if (options_.progress) options_.progress(result_.visited, options_.budget);
        ++result_.visited;
        SearchPoint point{named.settings, named.label, {}, {}};
        for (std::size_t scene = 0; scene < options_.sceneCount; ++scene) {
            const std::optional<CostError> value = options_.evaluate(named, scene);
            if (!value) {
                result_.stopped = true;
                --result_.visited;
                return;
            }
            point.scenes.push_back(*value);
            point.value = combineScenes(point.scenes);
            if (std::isnan(point.value.cost) || std::isnan(point.value.error)) {
                ++result_.refused;
                return;
            }
            if (mayAbandon && scene + 1 < options_.sceneCount && farBehind(point)) {
                ++result_.abandoned;
                return;
            }
        }
        if (position) onGrid_.push_back({*position, point.value});
        result_.points.push_back(std::move(point));
    }

    /// Another point is better by the margin in both, on the scenes that this one has seen.
    bool farBehind(const SearchPoint& point) const
    {
        return std::any_of(result_.points.begin(), result_.points.end(), [&](const SearchPoint& other) {
            const CostError there = combineScenes(std::span(other.scenes).first(point.scenes.size()));
            return there.cost * options_.abandonMargin <= point.value.cost && there.error * options_.abandonMargin <= point.value.error;
        });
    }

    std::vector<CostError> values() const
    {
        std::vector<CostError> values;
        for (const SearchPoint& point : result_.points) values.push_back(point.value);
        return values;
    }

    /// Neighbours of the front's points, and crosses of those next to each other on it.
    std::set<GridPosition> proposals(const std::vector<std::size_t>& front)
    {
        std::set<GridPosition> proposed;
        GridPosition previous;
        for (const std::size_t index : front) {
            const GridPosition here = grid_.nearest(result_.points[index].settings);
            proposed.insert(here);
            for (std::size_t axis = 0; axis < here.size(); ++axis)
                for (const int step : {-1, 1}) {
                    GridPosition moved = here;
                    moved[axis] += step;
                    proposed.insert(moved);
                    // One axis of the neighbour on the front: a cross where only one gene changes hands.
                    if (!previous.empty()) {
                        moved = step < 0 ? here : previous;
                        moved[axis] = step < 0 ? previous[axis] : here[axis];
                        proposed.insert(moved);
                    }
                }
            previous = here;
        }
        return proposed;
    }

    std::optional<GridPosition> mostPromising()
    {
        const std::vector<CostError> all = values();
        const std::vector<std::size_t> indices = paretoFront(all);
        std::vector<CostError> front;
        for (const std::size_t index : indices) front.push_back(all[index]);

        const StepEffects effects(grid_, onGrid_);
        std::optional<GridPosition> best;
        double bestGain = -std::numeric_limits<double>::infinity();
        for (const GridPosition& position : proposals(indices)) {
            if (!isNew(position)) continue;
            const std::optional<CostError> predicted = effects.predictLog(onGrid_, position);
            const double gain = predicted ? gainOverFront(front, *predicted) : 0.0;
            if (best && gain <= bestGain) continue;
            best = position;
            bestGain = gain;
        }
        return best;
    }

    std::optional<GridPosition> drawn()
    {
        for (int attempt = 0; attempt < 256; ++attempt) {
            GridPosition position;
            for (std::size_t axis = 0; axis < grid_.axisCount(); ++axis) position.push_back(int(random_() % std::uint64_t(grid_.valueCount(axis))));
            if (isNew(position)) return position;
        }
        return {};
    }

    /// The last resort, for grids that can be walked: after it nothing is left.
    std::optional<GridPosition> anyLeft()
    {
        if (grid_.size() > 65536.0) return {};
        GridPosition position = grid_.first();
        do {
            if (isNew(position)) return position;
        } while (grid_.advance(position));
        result_.exhausted = true;
        return {};
    }

    Settings base_;
    const SearchOptions& options_;
    SettingsGrid grid_;
    std::mt19937_64 random_;
    SearchResult result_;
    std::vector<GridPoint> onGrid_;
    std::set<GridPosition> seen_;
};

void requireOption(bool holds, const std::string& what, const std::string& why)
{
    if (!holds) throw InputError("search: " + what, why);
}

}  // namespace

SearchResult runFrontSearch(const Settings& base, const std::vector<Axis>& axes, const SearchOptions& options)
{
    requireOption(options.budget >= 1, "budget " + std::to_string(options.budget), "must be 1 or more settings");
    requireOption(options.abandonMargin > 1.0, "abandon margin", "must be above 1");
    requireOption(options.exploreEvery == 0 || options.exploreEvery >= 2, "explore every", "must be 0 or 2 and more");
    return FrontSearch(base, axes, options).run();
}

std::string describeSearch(const SearchResult& result)
{
    std::ostringstream out;
    out << result.visited << " settings visited, " << result.abandoned << " of them abandoned after some scenes; " << result.refused << " refused. "
        << result.front.size() << " of " << result.points.size() << " points are on the front.";
    if (result.exhausted) out << " Nothing was left to visit.";
    if (result.stopped) out << " Stopped before the budget was spent.";
    return out.str();
}

}  // namespace lrsm
