#include "apps/bench/bench_report.h"

#include "core/report/chart.h"
#include "core/report/html.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

namespace lrsm {
namespace {

using Json = nlohmann::ordered_json;

std::string fixedNumber(double value, int digits)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

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

std::string expectedText(const ScalingExpectation& expected)
{
    const auto text = [](double value) { return fixedNumber(value, value == std::floor(value) ? 0 : 1); };
    return expected.low == expected.high ? text(expected.low) : text(expected.low) + " .. " + text(expected.high);
}

/// Says nothing of what hardly changes: its exponent would be the noise's.
std::string offsetText(const ScalingCurve& curve)
{
    constexpr double kHardly = 1.25;
    const auto [smallest, largest] = std::minmax_element(curve.median.begin(), curve.median.end());
    if (!curve.offset || *largest < kHardly * *smallest) return "";
    const OffsetFit& fit = *curve.offset;
    return shortNumber(fit.constant) + " + " + shortNumber(fit.factor) + " x^" + fixedNumber(fit.exponent, 2);
}

/// The pass that the axis drives, from its first expectation: "cones_cpu_ms".
const ScalingCurve* drivenCurve(const MeasuredAxis& measured)
{
    return measured.result.find(measured.axis.expected.front().series);
}

std::string chartTitle(const MeasuredAxis& measured)
{
    std::string title = measured.axis.name;
    for (const char* series : {"frame_cpu_ms", ""}) {
        const ScalingCurve* curve = *series ? measured.result.find(series) : drivenCurve(measured);
        if (curve && curve->power) title += (*series ? ": " : ", ") + curve->series + " ~ x^" + fixedNumber(curve->power->exponent, 2);
    }
    return title;
}

Chart scalingChart(const MeasuredAxis& measured)
{
    Chart chart;
    chart.title = chartTitle(measured);
    chart.xLabel = measured.axis.xLabel;
    chart.yLabel = "ms (median)";
    chart.logX = chart.logY = true;
    constexpr std::array<const char*, 4> kColours = {"#4477aa", "#ee6677", "#228833", "#ccbb44"};
    std::vector<std::string> shown = {"frame_cpu_ms"};
    for (const ScalingExpectation& expected : measured.axis.expected)
        if (isTimeSeries(expected.series) && expected.series != shown.front() && shown.size() < kColours.size()) shown.push_back(expected.series);
    for (std::size_t s = 0; s < shown.size(); ++s) {
        const ScalingCurve* curve = measured.result.find(shown[s]);
        if (!curve) continue;
        ChartSeries points{curve->series, measured.result.x, curve->median, {}, false, false};
        points.colour = kColours[s];
        for (std::size_t i = 0; i < measured.result.points.size(); ++i)
            points.hover.push_back(measured.axis.points[measured.result.points[i]].label + ", spread " + fixedNumber(100.0 * curve->spread[i], 0) + " %");
        chart.series.push_back(std::move(points));
        if (!curve->power) continue;
        ChartSeries line{"x^" + fixedNumber(curve->power->exponent, 2), measured.result.x, {}, {}, true, true};
        line.colour = kColours[s];
        line.markerSize = 0.0;
        for (const double x : measured.result.x) line.y.push_back(curve->power->at(x));
        chart.series.push_back(std::move(line));
    }
    return chart;
}

Json curveJson(const ScalingCurve& curve)
{
    Json json = {{"series", curve.series}, {"median", curve.median}, {"min", curve.min}, {"spread", curve.spread}, {"power", nullptr}, {"offset", nullptr}};
    if (curve.power)
        json["power"] = {{"coefficient", curve.power->coefficient},
                         {"exponent", curve.power->exponent},
                         {"standard_error", curve.power->standardError},
                         {"r2", curve.power->r2}};
    if (curve.offset)
        json["offset"] = {
            {"constant", curve.offset->constant}, {"factor", curve.offset->factor}, {"exponent", curve.offset->exponent}, {"residual", curve.offset->residual}};
    return json;
}

Json axisJson(const MeasuredAxis& measured)
{
    Json json = {{"name", measured.axis.name}, {"x_label", measured.axis.xLabel}, {"fixed", measured.axis.fixed}, {"x", measured.result.x}};
    json["labels"] = Json::array();
    for (const std::size_t point : measured.result.points) json["labels"].push_back(measured.axis.points[point].label);
    json["left_out"] = measured.leftOut;
    json["expected"] = Json::array();
    for (const ScalingExpectation& expected : measured.axis.expected)
        json["expected"].push_back({{"series", expected.series}, {"low", expected.low}, {"high", expected.high}, {"why", expected.why}});
    json["curves"] = Json::array();
    for (const ScalingCurve& curve : measured.result.curves) json["curves"].push_back(curveJson(curve));
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

std::string benchCsvHead()
{
    std::string head = "axis,x,label,repeat,width,height,threads";
    for (const std::string& name : scalingSeriesNames()) head += "," + name;
    return head + "\n";
}

std::string benchCsvRow(const ScalingAxis& axis, const ScalingSample& sample)
{
    const ScalingPoint& point = axis.points[sample.point];
    const double x = axis.xSeries.empty() ? point.x : sample.values[scalingSeriesIndex(axis.xSeries)];
    std::string row = axis.name + "," + exactNumber(x) + "," + point.label + "," + std::to_string(sample.repeat) + "," + std::to_string(point.width) + "," +
                      std::to_string(point.height) + "," + std::to_string(point.threads);
    for (const double value : sample.values) row += "," + exactNumber(value);
    return row + "\n";
}

ReportTable exponentTable(const MeasuredAxis& measured)
{
    ReportTable table{measured.axis.name, {"series", "exponent", "+-", "r2", "a + b x^p", "expected", "because"}, {}};
    for (const ScalingExpectation& expected : measured.axis.expected) {
        const ScalingCurve* curve = measured.result.find(expected.series);
        if (!curve || !curve->power) continue;
        table.rows.push_back({expected.series, fixedNumber(curve->power->exponent, 3), fixedNumber(curve->power->standardError, 3),
                              fixedNumber(curve->power->r2, 3), offsetText(*curve), expectedText(expected), expected.why});
    }
    return table;
}

ReportTable pointTable(const MeasuredAxis& measured)
{
    std::vector<const ScalingCurve*> curves = {measured.result.find("frame_cpu_ms"), measured.result.find("frame_ms")};
    for (const ScalingExpectation& expected : measured.axis.expected)
        if (expected.series != "frame_cpu_ms" && expected.series != "frame_ms") curves.push_back(measured.result.find(expected.series));
    std::erase(curves, nullptr);
    ReportTable table{measured.axis.fixed, {measured.axis.xLabel}, {}};
    for (const ScalingCurve* curve : curves) {
        table.head.push_back(curve->series);
        if (curve->series == "frame_cpu_ms") table.head.emplace_back("spread %");
    }
    const bool threads = measured.axis.name == "threads";
    if (threads) table.head.insert(table.head.end(), {"speed-up", "efficiency"});
    const ScalingCurve* wall = measured.result.find("frame_ms");
    for (std::size_t i = 0; i < measured.result.points.size(); ++i) {
        std::vector<std::string> row = {measured.axis.points[measured.result.points[i]].label};
        for (const ScalingCurve* curve : curves) {
            row.push_back(shortNumber(curve->median[i]));
            if (curve->series == "frame_cpu_ms") row.push_back(fixedNumber(100.0 * curve->spread[i], 0));
        }
        if (threads && wall) {
            const double speedUp = wall->median.front() / wall->median[i];
            row.push_back(fixedNumber(speedUp, 2));
            row.push_back(fixedNumber(speedUp / measured.result.x[i], 2));
        }
        table.rows.push_back(std::move(row));
    }
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
                   (machine["load"].is_array() ? fixedNumber(machine["load"][0].get<double>(), 1) : "unknown") + " before; medians of " +
                   std::to_string(repeat) + ". _cpu_ms is processor time of all threads, dashed lines are least squares of the logarithms.";
    for (const MeasuredAxis& measured : axes) {
        page.bodyHtml += headingHtml(measured.axis.name) + paragraphHtml("Fixed: " + measured.axis.fixed + ".") + chartHtml(scalingChart(measured));
        page.bodyHtml += tableHtml(exponentTable(measured)) + foldedHtml("What was measured", tableHtml(pointTable(measured)));
        for (const std::string& note : measured.leftOut) page.bodyHtml += paragraphHtml("Left out: " + note);
    }
    return htmlPage(page);
}

}  // namespace lrsm
