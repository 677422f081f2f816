#pragma once

#include "apps/sweep/cases.h"

#include <optional>
#include <string>
#include <vector>

/// LRSM beside the path tracer at equal time and at equal error. Nothing below the truth's noise floor is claimed.
namespace lrsm {

/// What can be said of a figure that was looked up on a measured curve.
enum class Reach {
    measured,   ///< interpolated between measured points
    before,     ///< beyond the curve's cheap end: dearer or better than asked already at its first point
    beyond,     ///< beyond its dear end: never reached within what was measured
    belowFloor  ///< at or below the truth's noise: no figure means anything there
};

/// A figure and what it is worth.
struct Looked {
    Reach reach = Reach::measured;
    double value = 0.0;  ///< `before`, `beyond`: the curve's end; `belowFloor`: the noise floor
};

/// The path tracer's error for a cost, and its cost for an error. Of an empty curve: `beyond`, 0.
Looked errorAt(const std::vector<CostError>& curve, double cost, double floor);
Looked costAt(const std::vector<CostError>& curve, double error, double floor);

/// A preset against the path tracer in one case.
struct EqualRow {
    std::string name;                             ///< the case's
    const Measurement* row = nullptr;             ///< the preset's
    const Measurement* balanced = nullptr;        ///< of the case; nullptr: not measured
    bool atFloor = false;                         ///< the preset's own error is at or below the floor
    Looked tracerError, tracerCost;               ///< at the preset's cost; for the preset's error
    std::optional<double> errorRatio, costRatio;  ///< path tracer / preset, where both are measured (> 1: LRSM is better)
};
/// Each row of kind preset in each case that has a path tracer.
std::vector<EqualRow> presetsAgainstPathTracer(const std::vector<CaseRows>& cases);

/// A preset over all cases: geometric means of the ratios, where there is one.
struct EqualSummary {
    std::string preset;
    std::size_t cases = 0, errorRatios = 0, costRatios = 0;
    double errorRatio = 0.0, costRatio = 0.0;  ///< 0 without any
};
/// By first appearance.
std::vector<EqualSummary> summarizeEqual(const std::vector<EqualRow>& rows);

}  // namespace lrsm
