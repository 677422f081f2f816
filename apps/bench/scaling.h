#pragma once

#include "apps/bench/power_fit.h"
#include "conetrace/render.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// How cost grows: frames along an axis on which one size alone changes, timed and counted, with exponents fitted.
namespace lrsm {

/// What the axes are laid around.
struct ScalingBase {
    Scene scene;
    Camera camera;
    Settings settings;                     ///< each axis lowers voxel and RSM resolution of its own, so that what grows can be seen ...
    std::vector<std::string> assignments;  ///< ... and these "key=value" go over that
    std::optional<IVec2> size;             ///< of the picture, instead of the axis's own; the largest of the axis `pixels`
    bool quick = false;                    ///< three small values an axis: to see that it works
    int threads = 0;                       ///< of every axis but `threads`; 0: all
    int cores = 1;                         ///< the largest of the axis `threads`
};

/// One frame of an axis.
struct ScalingPoint {
    double x = 0.0;
    std::string label;
    std::shared_ptr<const Scene> scene;
    Settings settings;
    int width = 0, height = 0, threads = 0;
};

/// What theory says of a series: its exponent lies in [low, high].
struct ScalingExpectation {
    std::string series;  ///< as in scalingSeriesNames()
    double low = 0.0, high = 0.0;
    std::string why;  ///< a clause
};

struct ScalingAxis {
    std::string name, xLabel;
    std::string xSeries;                       ///< where x is what the frame turned out to have (layers kept); else empty
    std::string fixed;                         ///< all else, in words
    std::vector<ScalingExpectation> expected;  ///< the first is that of the pass that the axis drives
    Camera camera;
    std::vector<ScalingPoint> points;
};

/// pixels, cones, sets, layers, lights, voxels, rsm, triangles, threads: in the order of `lrsm bench`.
const std::vector<std::string>& scalingAxisNames();
/// InputError for an unknown name, and where the base cannot serve (no light).
ScalingAxis makeScalingAxis(const std::string& name, const ScalingBase& base);

/// What is written of each frame: frame_cpu_ms, frame_ms; of each pass PASS_cpu_ms, PASS_ms, PASS_bytes (lights summed, spaces as "_"); cones, cone_steps,
/// voxel_taps, lrsm_samples, voxels_set, triangles_drawn (RSMs and G-buffer), layers_kept, bytes, gpu_bytes.
const std::vector<std::string>& scalingSeriesNames();
/// Index of a series; throws std::logic_error for none.
std::size_t scalingSeriesIndex(const std::string& name);
/// Work counters and bytes are the same in every repeat; times are not.
bool isTimeSeries(const std::string& name);
std::vector<double> scalingValues(const Frame& frame);

/// One frame rendered.
struct ScalingSample {
    std::size_t point = 0;  ///< index into the axis
    int repeat = 0;
    std::vector<double> values;  ///< one a series
};

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

/// One series over an axis.
struct ScalingCurve {
    std::string series;
    std::vector<double> median, min, spread;  ///< one a point; spread: (largest - smallest) / median
    std::optional<PowerFit> power;            ///< of the medians
    std::optional<OffsetFit> offset;
};

struct ScalingResult {
    std::vector<std::size_t> points;   ///< of the axis, those that were rendered
    std::vector<double> x;             ///< one a point
    std::vector<ScalingCurve> curves;  ///< of every series that is not 0 throughout
    const ScalingCurve* find(const std::string& series) const;
};
ScalingResult summarizeScaling(const ScalingAxis& axis, const std::vector<ScalingSample>& samples);

}  // namespace lrsm
