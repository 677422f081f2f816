#pragma once

#include "apps/sweep/axes.h"
#include "apps/sweep/front.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The designed search for the front of cost against error over a grid of settings, for several scenes at once.
///
/// Method. Each axis goes from cheap and coarse to costly and fine. Start: the presets and, around the base, the neighbours and then the ends of each axis, for
/// at most half of the budget. Then one setting at a time, the most promising of: the neighbours of the front's points (one step up or down on one axis) and
/// crosses of points next to each other on the front; promise is how far the predicted point lies below the front, in logarithms (prediction: the nearest
/// visited point, and for each axis step between the mean effect that this step had where nothing else changed). Every `exploreEvery`-th setting is drawn at
/// random instead, so that the search does not get stuck.
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
    int budget = 100;  ///< settings visited, the abandoned included; >= 1
    std::uint64_t seed = 0;
    double abandonMargin = 1.3;        ///< > 1; infinite: nothing is abandoned
    int exploreEvery = 8;              ///< >= 2; 0: never
    std::vector<NamedSettings> start;  ///< presets; they need not lie on the grid

    std::size_t sceneCount = 1;
    /// Cost and error of one setting on one scene, relative to that scene's baseline (`relativeTo`). Nothing: stop now. A NaN: it cannot be rendered there.
    std::function<std::optional<CostError>(const NamedSettings&, std::size_t scene)> evaluate;
    std::function<bool()> stop = {};                             ///< asked before each setting
    std::function<void(int visited, int budget)> progress = {};  ///< before each setting
};

struct SearchResult {
    std::vector<SearchPoint> points;  ///< in the order visited; complete ones alone
    std::vector<std::size_t> front;   ///< of `points`, by rising cost
    int visited = 0;                  ///< settings that `evaluate` saw
    int abandoned = 0;                ///< of them: not on all scenes
    int refused = 0;                  ///< combinations without meaning
    bool exhausted = false;           ///< nothing was left to visit
    bool stopped = false;             ///< by `stop` or `evaluate`
};

/// Each axis must hold the base's value, or the grid's origin is its middle there. Throws InputError for options out of range and axes that `applySetting`
/// refuses.
SearchResult runFrontSearch(const Settings& base, const std::vector<Axis>& axes, const SearchOptions& options);

/// Text of the figures above in a sentence or two, for a summary.
std::string describeSearch(const SearchResult& result);

}  // namespace lrsm
