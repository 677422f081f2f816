#include "apps/bench/bench_report.h"

#include "apps/sweep/measurement.h"
#include "core/report/chart.h"
#include "core/report/html.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

namespace lrsm {
namespace {

using Json = nlohmann::ordered_json;

std::string valueOfCpuinfo(const std::string& key)
{
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(key) && line.find_first_not_of(" \t", key.size()) == line.find(':')) return line.substr(std::min(line.size(), line.find(':') + 2));
    return "unknown";
}

std::string compilerName()
{
#if defined(__clang__)
    return "clang++ " __clang_version__;
#else
    return "g++ " __VERSION__;
#endif
}

/// The frame, and the passes that take most of the largest one: processor time, but on the axis `threads` wall time.
std::vector<const ScalingCurve*> shownTimes(const MeasuredAxis& measured)
{
    constexpr std::size_t kPasses = 3;
    const std::string end = measured.axis.name == "threads" ? "_ms" : "_cpu_ms";
    std::vector<const ScalingCurve*> passes;
    for (const ScalingCurve& curve : measured.result.curves) {
        const bool processor = curve.series.ends_with("_cpu_ms"), time = curve.series.ends_with(end) && processor == (end == "_cpu_ms");
        if (time && !curve.series.starts_with("frame_")) passes.push_back(&curve);
    }
    std::stable_sort(passes.begin(), passes.end(), [](const auto* a, const auto* b) { return a->median.back() > b->median.back(); });
    passes.resize(std::min(passes.size(), kPasses));
    if (const ScalingCurve* frame = measured.result.find("frame" + end)) passes.insert(passes.begin(), frame);
    return passes;
}

Chart scalingChart(const MeasuredAxis& measured)
{
    Chart chart{.title = measured.axis.name, .xLabel = measured.axis.xLabel, .yLabel = "ms (median)", .logX = true, .logY = true, .series = {}};
    for (const ScalingCurve* curve : shownTimes(measured)) {
        ChartSeries series{.label = curve->series + (curve->slope ? " ~ x^" + fixedNumber(2, *curve->slope) : ""), .x = measured.result.x, .y = curve->median};
        for (std::size_t i = 0; i < measured.result.points.size(); ++i)
            series.hover.push_back(measured.axis.points[measured.result.points[i]].label + ", spread " + fixedNumber(0, 100.0 * curve->spread[i]) + " %");
        chart.series.push_back(std::move(series));
    }
    return chart;
}

Json axisJson(const MeasuredAxis& measured)
{
    Json json = {{"name", measured.axis.name}, {"x_label", measured.axis.xLabel}, {"fixed", measured.axis.fixed}, {"x", measured.result.x}};
    json["labels"] = Json::array();
    for (const std::size_t point : measured.result.points) json["labels"].push_back(measured.axis.points[point].label);
    json["left_out"] = measured.leftOut;
    json["curves"] = Json::array();
    for (const ScalingCurve& curve : measured.result.curves)
        json["curves"].push_back({{"series", curve.series},
                                  {"median", curve.median},
                                  {"min", curve.min},
                                  {"spread", curve.spread},
                                  {"slope", curve.slope ? Json(*curve.slope) : Json()}});
    return json;
}

}  // namespace

nlohmann::ordered_json machineJson()
{
    Json machine = {{"processor", valueOfCpuinfo("model name")},
                    {"family", valueOfCpuinfo("cpu family")},
                    {"model", valueOfCpuinfo("model")},
                    {"cores", std::thread::hardware_concurrency()},
                    {"compiler", compilerName()},
                    {"version", LRSM_VERSION}};
    double load[3] = {};
    machine["load"] = ::getloadavg(load, 3) == 3 ? Json{load[0], load[1], load[2]} : Json();
    return machine;
}

BenchRow benchRow(const ScalingAxis& axis, const ScalingSample& sample)
{
    const ScalingPoint& point = axis.points[sample.point];
    const double x = axis.xSeries.empty() ? point.x : counterSum(sample.values, axis.xSeries);
    return {{axis.name, exactNumber(x), point.label, std::to_string(sample.repeat), std::to_string(point.width), std::to_string(point.height),
             std::to_string(point.threads)},
            sample};
}

ReportTable benchTable(const std::vector<BenchRow>& rows)
{
    std::vector<ScalingSample> samples;
    for (const BenchRow& row : rows) samples.push_back(row.sample);
    const std::vector<std::string> series = seriesNames(samples);
    ReportTable table{"", {"axis", "x", "label", "repeat", "width", "height", "threads"}, {}};
    table.head.insert(table.head.end(), series.begin(), series.end());
    for (const BenchRow& row : rows) {
        table.rows.push_back(row.place);
        for (const std::string& name : series) table.rows.back().push_back(exactNumber(counterSum(row.sample.values, name)));
    }
    return table;
}

ReportTable pointTable(const MeasuredAxis& measured)
{
    std::vector<const ScalingCurve*> curves = shownTimes(measured);
    for (const char* name : {"frame_ms", "frame_cpu_ms", "cone_steps", "voxel_taps", "lrsm_samples", "bytes"})
        if (const ScalingCurve* curve = measured.result.find(name); curve && std::find(curves.begin(), curves.end(), curve) == curves.end())
            curves.push_back(curve);
    ReportTable table{measured.axis.name + ": " + measured.axis.fixed, {measured.axis.xLabel}, {}};
    for (const ScalingCurve* curve : curves) table.head.push_back(curve->series);
    table.head.emplace_back("spread %");
    for (std::size_t i = 0; i < measured.result.points.size(); ++i) {
        std::vector<std::string> row = {measured.axis.points[measured.result.points[i]].label};
        for (const ScalingCurve* curve : curves) row.push_back(shortNumber(curve->median[i]));
        row.push_back(fixedNumber(0, 100.0 * curves.front()->spread[i]));
        table.rows.push_back(std::move(row));
    }
    std::vector<std::string> slopes = {"grows as x to the"};
    for (const ScalingCurve* curve : curves) slopes.push_back(curve->slope ? fixedNumber(2, *curve->slope) : "");
    table.rows.push_back(std::move(slopes));
    return table;
}

nlohmann::ordered_json benchJson(const std::vector<MeasuredAxis>& axes, const nlohmann::ordered_json& machine, int repeat)
{
    Json json = {{"machine", machine}, {"load_at_end", machineJson()["load"]}, {"repeat", repeat}};
    json["axes"] = Json::array();
    for (const MeasuredAxis& measured : axes) json["axes"].push_back(axisJson(measured));
    return json;
}

std::string benchPage(const std::vector<MeasuredAxis>& axes, const nlohmann::ordered_json& machine, int repeat)
{
    HtmlPage page{"lrsm bench: how cost grows", "", "", chartStyle(), chartScript()};
    page.summary = machine["processor"].get<std::string>() + ", " + machine["compiler"].get<std::string>() + ", load average " +
                   (machine["load"].is_array() ? fixedNumber(1, machine["load"][0].get<double>()) : "unknown") + " before; medians of " +
                   std::to_string(repeat) + ". _cpu_ms is processor time of all threads, _ms wall time; x^p: least squares of the logarithms.";
    for (const MeasuredAxis& measured : axes) {
        page.bodyHtml += headingHtml(measured.axis.name) + paragraphHtml("Fixed: " + measured.axis.fixed + ".") + chartHtml(scalingChart(measured));
        page.bodyHtml += foldedHtml("In numbers", tableHtml(pointTable(measured)));
        for (const std::string& note : measured.leftOut) page.bodyHtml += paragraphHtml("Left out: " + note);
    }
    return htmlPage(page);
}

}  // namespace lrsm
