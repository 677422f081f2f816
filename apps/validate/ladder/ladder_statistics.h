#pragma once

#include "apps/validate/ladder/ladder.h"

#include <span>

namespace lrsm {

/// What one ladder is: its rungs, and where a sample keeps their values.
struct LadderView {
    std::string quantity;  ///< for the verdict: "the radiance L"
    std::vector<RungInfo> rungs;
    std::function<double(const LadderSample&, std::size_t rung)> value;
    struct Variable {
        std::string name, unit;
        std::function<double(const LadderSample&)> value;
        bool integer = false;  ///< one bin a value
    };
    std::vector<Variable> variables;
    std::function<double(const LadderSample&)> weight;  ///< of the weighted means
};
LadderView radianceView();
LadderView visibilityView();
LadderView emissionView();

/// Differences, each with its weight (>= 0; all 0 counts as all 1).
DifferenceStatistics describeDifferences(std::vector<double> differences, std::span<const double> weights);

/// Statistics, curves, worst cases and verdict of the samples that `included` lists (indices into `samples`).
Ladder describeLadder(const LadderView& view, const std::vector<LadderSample>& samples, const std::vector<std::size_t>& included, int worstPerRung);

}  // namespace lrsm
