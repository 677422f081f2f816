#pragma once

#include "apps/bench/scaling_axes.h"
#include "conetrace/render.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// How cost grows: the frames of an axis, timed and counted, with the slope of each series.
namespace lrsm {

/// What is written of each frame, by name: frame_cpu_ms, frame_ms; of each family of passes PASS_cpu_ms, PASS_ms, PASS_bytes (spaces as "_"); what the
/// passes counted; bytes and gpu_bytes, of the resident passes. Passes and counters are those that the frame reported.
Counters scalingValues(const Frame& frame);
/// One frame rendered.
struct ScalingSample {
    std::size_t point = 0;  ///< index into the axis
    int repeat = 0;
    Counters values;
};

/// All names in these samples, in the order of their first appearance.
std::vector<std::string> seriesNames(const std::vector<ScalingSample>& samples);

struct ScalingRun {
    std::vector<ScalingSample> samples;
    std::vector<std::string> leftOut;  ///< points that the machine has no memory for: "1024^3: why"
};

/// Renders every point `repeat` times, round robin: a slow minute of the machine hits all points alike. The first point is rendered once before,
/// unmeasured.
struct ScalingWatch {
    std::function<void(const ScalingSample&)> each = {};  ///< every sample as it comes
    std::function<void(const std::string& what, double fraction)> progress = {};
    std::function<bool()> stop = {};  ///< asked before each frame: end with what there is?
};
ScalingRun runScaling(const ScalingAxis& axis, int repeat, const ScalingWatch& watch = {});

/// p of y = a x^p: least squares of the logarithms. Nothing where a value is not positive and finite, or without two different x.
std::optional<double> logLogSlope(std::span<const double> x, std::span<const double> y);

/// One series over an axis.
struct ScalingCurve {
    std::string series;
    std::vector<double> median, min, spread;  ///< one a point; spread: (largest - smallest) / median
    std::optional<double> slope;              ///< logLogSlope of the medians
};

struct ScalingResult {
    std::vector<std::size_t> points;   ///< of the axis, those that were rendered
    std::vector<double> x;             ///< one a point
    std::vector<ScalingCurve> curves;  ///< of every series that is not 0 throughout
    const ScalingCurve* find(const std::string& series) const;
};
ScalingResult summarizeScaling(const ScalingAxis& axis, const std::vector<ScalingSample>& samples);

}  // namespace lrsm
