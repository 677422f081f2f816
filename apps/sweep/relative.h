#pragma once

#include "apps/sweep/front.h"
#include "apps/sweep/measurement.h"

#include <span>
#include <vector>

/// Rows over a baseline of the same case, so that scenes of any brightness and cost can be averaged.
namespace lrsm {

/// Cost and net error of a row over those of `baseline`, a row of the same case (the preset `balanced`). Errors below 1e-6 count as 1e-6, so that exact
/// pictures have ratios.
CostError relativeTo(const Measurement& row, const Measurement& baseline);

/// Geometric means of cost and error: each scene counts alike, however dear or hard it is. NaN where there is none, or where one of them is NaN.
CostError combineScenes(std::span<const CostError> scenes);

/// One setting's rows, each over the baseline of its case; InputError when a row's case has no baseline.
CostError combineScenes(const std::vector<Measurement>& rows, const std::vector<Measurement>& baselines);

/// exp of the mean of logarithms; 1 for none. Of values > 0.
double geometricMean(const std::vector<double>& values);

}  // namespace lrsm
