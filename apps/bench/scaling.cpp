#include "apps/bench/scaling.h"

#include "apps/sweep/measurement.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

namespace lrsm {
namespace {

constexpr std::array<const char*, 3> kColumnsOfPass = {"_cpu_ms", "_ms", "_bytes"};

std::size_t passIndex(const std::string& name)
{
    const std::vector<std::string>& passes = measuredPasses();
    const auto at = std::find(passes.begin(), passes.end(), passFamily(name));
    if (at == passes.end()) throw std::logic_error("pass \"" + name + "\" has no column");
    return static_cast<std::size_t>(at - passes.begin());
}

std::vector<std::string> makeSeriesNames()
{
    std::vector<std::string> names = {"frame_cpu_ms", "frame_ms"};
    for (std::string pass : measuredPasses()) {
        std::replace(pass.begin(), pass.end(), ' ', '_');
        for (const char* what : kColumnsOfPass) names.push_back(pass + what);
    }
    for (const char* name : {"cones", "cone_steps", "voxel_taps", "lrsm_samples", "voxels_set", "triangles_drawn", "layers_kept", "bytes", "gpu_bytes"})
        names.emplace_back(name);
    return names;
}

ScalingSample renderPoint(const ScalingAxis& axis, std::size_t index, int repeat)
{
    const ScalingPoint& point = axis.points[index];
    const ThreadLimit threads(point.threads);
    RenderOptions options;
    options.width = point.width;
    options.height = point.height;
    options.hashPasses = false;
    const Requirements needs = analyseRequirements(*point.scene, point.settings.force);
    return {index, repeat, scalingValues(renderFrame(*point.scene, axis.camera, needs, point.settings, options))};
}

ScalingCurve curveOf(const std::string& name, std::size_t series, const std::vector<std::vector<const ScalingSample*>>& byPoint, const std::vector<double>& x)
{
    ScalingCurve curve;
    curve.series = name;
    for (const auto& samples : byPoint) {
        std::vector<double> values;
        for (const ScalingSample* sample : samples) values.push_back(sample->values[series]);
        const RepeatedTime repeats = summarize(std::move(values));
        curve.median.push_back(repeats.median);
        curve.min.push_back(repeats.min);
        curve.spread.push_back(repeats.spread);
    }
    curve.slope = logLogSlope(x, curve.median);
    return curve;
}

}  // namespace

const std::vector<std::string>& scalingSeriesNames()
{
    static const std::vector<std::string> names = makeSeriesNames();
    return names;
}

std::size_t scalingSeriesIndex(const std::string& name)
{
    const auto& names = scalingSeriesNames();
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) throw std::logic_error("no series \"" + name + "\"");
    return static_cast<std::size_t>(at - names.begin());
}

std::vector<double> scalingValues(const Frame& frame)
{
    double frameCpu = 0.0, frameWall = 0.0;
    std::vector<std::array<double, kColumnsOfPass.size()>> passes(measuredPasses().size());
    std::size_t bytes = 0, gpuBytes = 0;
    for (const PassReport& pass : frame.passes) {
        frameCpu += pass.cpuMilliseconds;
        frameWall += pass.milliseconds;
        std::array<double, kColumnsOfPass.size()>& sums = passes[passIndex(pass.name)];
        sums[0] += pass.cpuMilliseconds;
        sums[1] += pass.milliseconds;
        sums[2] += static_cast<double>(pass.bytes);
        if (pass.name == "voxelize") continue;  // its grid goes on as the pyramid's base
        bytes += pass.bytes;
        gpuBytes += pass.gpuBytes;
    }
    std::uint64_t drawn = frame.gbufferRaster.drawn;
    std::size_t layers = 0;
    for (const Frame::LightReport& light : frame.lights) {
        drawn += light.raster.drawn;
        layers += light.ranges.size();
    }
    std::vector<double> values = {frameCpu, frameWall};
    for (const auto& sums : passes) values.insert(values.end(), sums.begin(), sums.end());
    for (const std::uint64_t count : {frame.cones.cones, frame.cones.steps, frame.cones.voxelTaps, frame.cones.lrsmSamples, frame.voxelsSet, drawn,
                                      std::uint64_t(layers), std::uint64_t(bytes), std::uint64_t(gpuBytes)})
        values.push_back(static_cast<double>(count));
    return values;
}

ScalingRun runScaling(const ScalingAxis& axis, int repeat, const ScalingWatch& watch)
{
    ScalingRun run;
    std::set<std::size_t> tooLarge;
    const double frames = static_cast<double>(axis.points.size()) * repeat;
    double done = 0.0;
    if (!axis.points.empty()) renderPoint(axis, 0, 0);  // pages, caches and threads are cold once
    for (int i = 0; i < repeat; ++i)
        for (std::size_t point = 0; point < axis.points.size(); ++point, done += 1.0) {
            if (tooLarge.count(point)) continue;
            if (watch.stop && watch.stop()) return run;
            if (watch.progress) watch.progress(axis.name + " " + axis.points[point].label, done / frames);
            try {
                run.samples.push_back(renderPoint(axis, point, i));
            } catch (const MachineError& error) {
                tooLarge.insert(point);
                run.leftOut.push_back(axis.points[point].label + ": " + error.what());
                continue;
            }
            if (watch.each) watch.each(run.samples.back());
        }
    return run;
}

std::optional<double> logLogSlope(std::span<const double> x, std::span<const double> y)
{
    double n = 0.0, sumX = 0.0, sumY = 0.0, sumXX = 0.0, sumXY = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!(x[i] > 0.0 && y[i] > 0.0 && std::isfinite(x[i]) && std::isfinite(y[i]))) return {};
        const double a = std::log(x[i] / x[0]), b = std::log(y[i] / y[0]);
        n += 1.0;
        sumX += a;
        sumY += b;
        sumXX += a * a;
        sumXY += a * b;
    }
    const double spread = n * sumXX - sumX * sumX;
    if (!(spread > 0.0)) return {};
    return (n * sumXY - sumX * sumY) / spread;
}

const ScalingCurve* ScalingResult::find(const std::string& series) const
{
    for (const ScalingCurve& curve : curves)
        if (curve.series == series) return &curve;
    return nullptr;
}

ScalingResult summarizeScaling(const ScalingAxis& axis, const std::vector<ScalingSample>& samples)
{
    ScalingResult result;
    std::vector<std::vector<const ScalingSample*>> byPoint;
    for (std::size_t point = 0; point < axis.points.size(); ++point) {
        std::vector<const ScalingSample*> own;
        for (const ScalingSample& sample : samples)
            if (sample.point == point) own.push_back(&sample);
        if (own.empty()) continue;
        result.points.push_back(point);
        result.x.push_back(axis.xSeries.empty() ? axis.points[point].x : own.front()->values[scalingSeriesIndex(axis.xSeries)]);
        byPoint.push_back(std::move(own));
    }
    const auto& names = scalingSeriesNames();
    for (std::size_t series = 0; series < names.size(); ++series) {
        ScalingCurve curve = curveOf(names[series], series, byPoint, result.x);
        if (std::any_of(curve.median.begin(), curve.median.end(), [](double value) { return value != 0.0; })) result.curves.push_back(std::move(curve));
    }
    return result;
}

}  // namespace lrsm
