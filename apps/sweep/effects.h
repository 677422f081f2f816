#pragma once

#include "apps/sweep/cases.h"

#include <cstddef>
#include <string>
#include <vector>

/// What each value of each setting costs and buys, one at a time around a preset.
namespace lrsm {

enum class EffectKind {
    winsBoth,       ///< less error, and no more time
    buys,           ///< less error for more time
    saves,          ///< less time for more error
    losesBoth,      ///< no less error, and no less time
    changesNothing  ///< equal bits of irradiance in every case
};

/// A value against its base, over the cases that have both. Changes are ratio - 1 with the ratio a geometric mean over the cases.
struct Effect {
    std::string label, base;  ///< "cone_count=4", "balanced"; "density_k=4", "balanced estimator=paper": with what the value needs beside it
    EffectKind kind = EffectKind::losesBoth;
    std::size_t cases = 0, changed = 0;           ///< measured in; where a bit of the irradiance differs
    double error = 0.0, cost = 0.0, bytes = 0.0;  ///< changes; -0.1: 10 % less
    double worstError = 0.0;                      ///< largest change of error in one case
    double milliseconds = 0.0;                    ///< change of cost in processor time, mean over the cases, each times `unit`
    /// `buys`, `saves`: 100 |error| / |milliseconds|, percent of the error a millisecond: what a millisecond buys, or what a millisecond saved is paid with.
    double percentPerMs = 0.0;
};

/// A change of cost below `tolerance` counts as none. `unit`: milliseconds of a calibration frame.
/// What is looked at: rows of kind axis around their base, and rows that differ from `balanced` in one setting.
/// Order: winsBoth by error; buys by rising price; saves by falling worth (most time per error first); losesBoth; changesNothing.
std::vector<Effect> effectsOf(const std::vector<CaseRows>& cases, double unit, double tolerance);

/// Median |change of cost| of rows that change no bit, over all cases; 0 without any: what the clock alone makes of equal work.
double costNoise(const std::vector<CaseRows>& cases);

/// Median processor time of the calibration frames, ms; smallest and largest beside it.
struct CalibrationUnit {
    double median = 0.0, min = 0.0, max = 0.0;
};
CalibrationUnit calibrationUnit(const std::vector<Measurement>& rows);

}  // namespace lrsm
