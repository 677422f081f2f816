#include "apps/bench/scaling.h"

#include "apps/sweep/measurement.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lrsm {
namespace {

ScalingSample renderPoint(const ScalingAxis& axis, std::size_t index, int repeat)
{
    const ScalingPoint& point = axis.points[index];
    const ThreadLimit threads(point.threads);
    RenderOptions options;
    options.width = point.width;
    options.height = point.height;
    options.watch.hashPasses = false;
    return {index, repeat, scalingValues(renderFrame(*point.scene, axis.camera, point.settings, options))};
}

ScalingCurve curveOf(const std::string& name, const std::vector<std::vector<const ScalingSample*>>& byPoint, const std::vector<double>& x)
{
    ScalingCurve curve;
    curve.series = name;
    for (const auto& samples : byPoint) {
        std::vector<double> values;
        for (const ScalingSample* sample : samples) values.push_back(counterSum(sample->values, name));
        const RepeatedTime repeats = summarize(std::move(values));
        curve.median.push_back(repeats.median);
        curve.min.push_back(repeats.min);
        curve.spread.push_back(repeats.spread);
    }
    curve.slope = logLogSlope(x, curve.median);
    return curve;
}

}  // namespace

Counters scalingValues(const Frame& frame)
{
    Counters values = {{"frame_cpu_ms", 0.0}, {"frame_ms", 0.0}};
    for (const PassReport& pass : frame.passes) {
        const std::string column = passColumn(passFamily(pass.name));
        addTo(values, {"frame_cpu_ms", pass.cpuMilliseconds});
        addTo(values, {"frame_ms", pass.milliseconds});
        addTo(values, {column + "_cpu_ms", pass.cpuMilliseconds});
        addTo(values, {column + "_ms", pass.milliseconds});
        addTo(values, {column + "_bytes", static_cast<double>(pass.bytes)});
    }
    for (const PassReport& pass : frame.passes)
        for (const Counter& counter : pass.counters) addTo(values, counter);
    for (const PassReport& pass : frame.passes) {
        addTo(values, {"bytes", pass.traits.resident ? static_cast<double>(pass.bytes) : 0.0});
        addTo(values, {"gpu_bytes", pass.traits.resident ? static_cast<double>(pass.gpuBytes) : 0.0});
    }
    return values;
}

std::vector<std::string> seriesNames(const std::vector<ScalingSample>& samples)
{
    std::vector<std::string> names;
    std::set<std::string> known;
    for (const ScalingSample& sample : samples)
        for (const Counter& value : sample.values)
            if (known.insert(value.name).second) names.push_back(value.name);
    return names;
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
        result.x.push_back(axis.xSeries.empty() ? axis.points[point].x : counterSum(own.front()->values, axis.xSeries));
        byPoint.push_back(std::move(own));
    }
    for (const std::string& name : seriesNames(samples)) {
        ScalingCurve curve = curveOf(name, byPoint, result.x);
        if (std::any_of(curve.median.begin(), curve.median.end(), [](double value) { return value != 0.0; })) result.curves.push_back(std::move(curve));
    }
    return result;
}

}  // namespace lrsm
