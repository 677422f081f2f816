#pragma once

#include "apps/sweep/axes.h"
#include "apps/sweep/measurement.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// Chooses among settings for one scene and a budget: probes them small, predicts the asked size, verifies by a run there. Rows come from the caller, so that
/// nothing here renders.
namespace lrsm {

enum class TuneMetric {
    rmse,   ///< net RMSE / mean
    flip,   ///< mean LDR-FLIP
    energy  ///< |energy ratio - 1|
};
double tunedError(const PictureError& error, TuneMetric metric);

struct TuneBudget {
    std::optional<double> error;         ///< of the metric, > 0
    std::optional<double> milliseconds;  ///< wall time of a frame, on this machine when nothing else runs
    std::optional<double> cost;          ///< the same in calibration frames, where another machine is meant or this one is never quiet
    std::optional<double> megabytes;     ///< of 10^6 bytes
    TuneMetric metric = TuneMetric::rmse;
};
/// Throws InputError: nothing asked for, or a figure that is not above 0.
void validate(const TuneBudget& budget);

/// Samples a pixel that the truth needs before an error of `error` is above its noise: noise falls with their root. A power of two.
std::uint64_t samplesNeeded(double noise, std::uint64_t samples, double error);

/// What a calibration frame means in milliseconds. Of all runs the least counts: other programs can only slow a run.
struct TimeScale {
    double calibrationCpu = std::numeric_limits<double>::infinity();  ///< processor time of the calibration frame, ms; infinite: not run yet
    double wallPerCpu = 1.0;  ///< wall time over processor time of a frame: 1 / threads where they share the work evenly
    double milliseconds(double cost) const { return cost * calibrationCpu * wallPerCpu; }
};
/// `before` and what the rows of this process add to it.
TimeScale timeScale(TimeScale before, const std::vector<Measurement>& rows);

/// Cost of the row's settings at another size: passes over pixels go with their number, the others stay. Their shares are the row's.
double costAtSize(const Measurement& row, int width, int height);

struct TuneFigures {
    double error = 0.0, cost = 0.0, milliseconds = 0.0, megabytes = 0.0;
};

/// One setting that may be chosen.
struct TunePoint {
    NamedSettings named;
    double megabytes = 0.0;               ///< exact, at the asked size
    std::optional<Measurement> probe;     ///< at the probe's size
    std::optional<Measurement> verified;  ///< at the asked size
    std::string skipped;                  ///< why it was not probed
    std::vector<std::string> trimmed;     ///< what the scene does not require, and why: already in `named`
};

struct TuneRequest {
    TuneBudget budget;
    int width = 640, height = 360;  ///< the asked size
    int maxVerifications = 3;       ///< >= 1
    TimeScale before = {};          ///< of calibration frames run beforehand: the fastest, and the least wall time over processor time
    int threads = 1;                ///< that render a frame
};

/// Verified over predicted, geometric mean over what has been verified: what the small size did not show.
struct TuneCorrection {
    double error = 1.0, cost = 1.0;
};

struct TuneResult {
    std::vector<TunePoint> points;       ///< in the order given
    std::optional<std::size_t> chosen;   ///< verified, and within the budget
    std::optional<std::size_t> nearest;  ///< where nothing is: the point whose worst excess is least; of the least memory when all are over it
    TuneCorrection correction;
    TimeScale scale;
};

/// As verified, else as predicted from the probe and the correction. Nothing for a point without either.
std::optional<TuneFigures> figuresOf(const TunePoint& point, const TuneRequest& request, const TuneCorrection& correction, const TimeScale& scale);

/// The largest figure over what the budget gives it; at most 1: within the budget.
double excess(const TuneFigures& figures, const TuneBudget& budget);

struct TuneActions {
    std::function<Measurement(const NamedSettings&)> probe, verify;
};

/// With an error asked for: the cheapest point that meets all. Without: the smallest error that meets the rest, the cheaper of two equal ones.
///
/// `points` go from cheap to costly. They are probed in this order, as far as needed: what is over the memory is not, what follows a point of 1.5 times the
/// time is not, and with an error asked for, what follows two points within the budget is not. The best prediction is verified; when it fails, and when the
/// verified figures shift the other predictions, the next best is, and once a point holds, a better one that is predicted up to 5 % outside the budget:
/// `maxVerifications` times in all. Before nothing is found, the nearest is verified too.
TuneResult tune(std::vector<TunePoint> points, const TuneRequest& request, const TuneActions& actions);

}  // namespace lrsm
