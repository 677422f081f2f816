#pragma once

#include "apps/sweep/axes.h"
#include "apps/sweep/front.h"
#include "apps/sweep/relative.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The designed search for the front of cost against error over a grid of settings, in the manner of FAISS' ParameterSpace and OperatingPoints (what cannot
/// win by monotonicity is never rendered), for an error that is not monotone and for several scenes at once.
///
/// Method. Each axis goes from cheap and coarse to costly and fine. Start: the presets and, around the base, the neighbours and then the ends of each axis, for
/// at most half of the budget. Then one setting at a time, the most promising of: the neighbours of the front's points (one step up or down on one axis) and
/// crosses of points next to each other on the front; promise is how far the predicted point lies below the front, in logarithms (prediction: the nearest
/// visited point, and for each axis step between the mean effect that this step had where nothing else changed). Every `exploreEvery`-th setting is drawn at
/// random instead, so that the search does not get stuck.
///
/// Pruning. Lower bounds of a setting that has not been rendered: its cost is at least (1 - costSlack) of that of any visited setting that is nowhere finer,
/// its error at least (1 - slack) of that of any visited setting that is nowhere coarser. When a visited point is at most both, the setting is pruned. With a
/// true monotone cost and error and slacks of 0 no point of the front is lost. Here error is not monotone: a seeded sample of the pruned settings is visited
/// anyway, and how many of them are on the front is reported.
///
/// Abandonment. Scenes are rendered one after another. After each, the point so far (the mean over these scenes) is held against what every complete point
/// had on the same scenes: when one is better by the factor `abandonMargin` in both, the rest is left out.
///
/// Everything follows from the seed and from what `evaluate` returns: with stored rows behind it, resuming is replaying.
namespace lrsm {

struct SearchPoint {
    Settings settings;
    std::string label;              ///< the preset's name, or what differs from the base: "cone_count=4 voxel_resolution=256"
    CostError value;                ///< over all scenes
    std::vector<CostError> scenes;  ///< one by one
};

struct SearchOptions {
    int budget = 100;  ///< settings visited, the abandoned and those of the pruning's check included; >= 1
    std::uint64_t seed = 0;
    double slack = 0.1;                ///< of the error's lower bound, [0, 1]; 1: nothing is pruned
    double costSlack = 0.02;           ///< of the cost's lower bound, [0, 1]
    double abandonMargin = 1.3;        ///< > 1; infinite: nothing is abandoned
    int exploreEvery = 8;              ///< >= 2; 0: never
    int pruneChecks = 6;               ///< pruned settings that are visited at the end, within the budget
    std::vector<NamedSettings> start;  ///< presets; they need not lie on the grid

    std::size_t sceneCount = 1;
    /// Cost and error of one setting on one scene, relative to that scene's baseline (`relativeTo`). Nothing: stop now. A NaN: it cannot be rendered there.
    std::function<std::optional<CostError>(const NamedSettings&, std::size_t scene)> evaluate;
    std::function<bool()> stop = {};                             ///< asked before each setting
    std::function<void(int visited, int budget)> progress = {};  ///< before each setting
};

struct SearchResult {
    std::vector<SearchPoint> points;         ///< in the order visited; complete ones alone
    std::vector<std::size_t> front;          ///< of `points`, by rising cost
    int visited = 0;                         ///< settings that `evaluate` saw
    int abandoned = 0;                       ///< of them: not on all scenes
    int pruned = 0;                          ///< settings that came up and were never rendered, those of the check not counted
    int refused = 0;                         ///< combinations without meaning
    int checked = 0, missed = 0;             ///< pruned settings visited anyway; those of them that are on the front
    int pairs = 0;                           ///< visited pairs on the grid, one of them nowhere coarser than the other
    int violations = 0, costViolations = 0;  ///< pairs whose errors, whose costs falsify the slack
    bool exhausted = false;                  ///< nothing was left to visit
    bool stopped = false;                    ///< by `stop` or `evaluate`
};

/// Each axis must hold the base's value, or the grid's origin is its middle there. Throws InputError for options out of range and axes that `applySetting`
/// refuses.
SearchResult runFrontSearch(const Settings& base, const std::vector<Axis>& axes, const SearchOptions& options);

/// Text of the figures above in one or two sentences, for a summary.
std::string describeSearch(const SearchResult& result);

}  // namespace lrsm
