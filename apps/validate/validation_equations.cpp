#include "apps/validate/validation_report.h"
#include "core/report/chart.h"
#include "core/report/html.h"

#include <nlohmann/json.hpp>

namespace lrsm {
namespace {

using Json = nlohmann::ordered_json;

std::string nanosecondsCell(double nanoseconds)
{
    return nanoseconds > 0.0 ? shortNumber(nanoseconds) : "";
}

ReportTable checksForPeople(const EquationReport& report, bool whole)
{
    ReportTable table{"Each function against its oracle", {"Eq.", "function", "error", "worst", "bound", "worst/bound", "ns"}, {}};
    if (whole) table.head.insert(table.head.end(), {"bound's name", "oracle", "domain", "mean", "evaluations", "worst at"});
    for (const EquationCheck& c : report.checks) {
        std::vector<std::string> row = {(c.holds() ? "" : "!") + c.equation,
                                        c.function,
                                        c.errorKind,
                                        shortNumber(c.worst),
                                        shortNumber(c.bound.value),
                                        c.bound.value > 0.0 ? shortNumber(c.worst / c.bound.value) : "",
                                        nanosecondsCell(c.nanoseconds)};
        if (whole) row.insert(row.end(), {c.bound.name, c.oracle, c.domain, shortNumber(c.meanError), std::to_string(c.evaluations), c.worstInput});
        table.rows.push_back(std::move(row));
    }
    return table;
}

ReportTable tradesForPeople(const EquationReport& report)
{
    ReportTable table{"Choices: error beside time", {"setting", "choice", "error of", "worst", "bound", "mean", "bias", "ns", "bytes"}, {}};
    for (const EquationTrade& t : report.trades)
        table.rows.push_back({t.setting, t.choice, t.quantity, shortNumber(t.worst), shortNumber(t.bound), shortNumber(t.meanError), shortNumber(t.bias),
                              nanosecondsCell(t.nanoseconds), t.bytes ? std::to_string(t.bytes) : ""});
    return table;
}

ReportTable checksForPrograms(const EquationReport& report)
{
    ReportTable table{"",
                      {"equation", "function", "oracle", "domain", "bound_name", "error_kind", "bound", "worst", "mean_error", "worst_input", "evaluations",
                       "nanoseconds", "holds"},
                      {}};
    for (const EquationCheck& c : report.checks)
        table.rows.push_back({c.equation, c.function, c.oracle, c.domain, c.bound.name, c.errorKind, exactNumber(c.bound.value), exactNumber(c.worst),
                              exactNumber(c.meanError), c.worstInput, std::to_string(c.evaluations), exactNumber(c.nanoseconds), c.holds() ? "1" : "0"});
    return table;
}

ReportTable tradesForPrograms(const EquationReport& report)
{
    ReportTable table{"", {"setting", "choice", "quantity", "bound", "worst", "mean_error", "bias", "nanoseconds", "bytes"}, {}};
    for (const EquationTrade& t : report.trades)
        table.rows.push_back({t.setting, t.choice, t.quantity, exactNumber(t.bound), exactNumber(t.worst), exactNumber(t.meanError), exactNumber(t.bias),
                              exactNumber(t.nanoseconds), std::to_string(t.bytes)});
    return table;
}

Json equationsJson(const EquationReport& report)
{
    Json checks = Json::array(), trades = Json::array(), curves = Json::array();
    for (const EquationCheck& c : report.checks)
        checks.push_back({{"equation", c.equation},
                          {"function", c.function},
                          {"oracle", c.oracle},
                          {"domain", c.domain},
                          {"boundName", c.bound.name},
                          {"errorKind", c.errorKind},
                          {"bound", c.bound.value},
                          {"worst", c.worst},
                          {"meanError", c.meanError},
                          {"worstInput", c.worstInput},
                          {"evaluations", c.evaluations},
                          {"nanoseconds", c.nanoseconds},
                          {"holds", c.holds()}});
    for (const EquationTrade& t : report.trades)
        trades.push_back({{"setting", t.setting},
                          {"choice", t.choice},
                          {"quantity", t.quantity},
                          {"bound", t.bound},
                          {"worst", t.worst},
                          {"meanError", t.meanError},
                          {"bias", t.bias},
                          {"nanoseconds", t.nanoseconds},
                          {"bytes", t.bytes}});
    for (const auto& [equation, chart] : report.curves) {
        Json series = Json::array();
        for (const ChartSeries& s : chart.series) series.push_back({{"name", s.label}, {"x", s.x}, {"y", s.y}});
        curves.push_back({{"equation", equation}, {"title", chart.title}, {"xLabel", chart.xLabel}, {"yLabel", chart.yLabel}, {"series", std::move(series)}});
    }
    return {{"checks", std::move(checks)}, {"trades", std::move(trades)}, {"curves", std::move(curves)}};
}

std::string curvesHtml(const EquationReport& report)
{
    std::string html;
    for (auto [equation, chart] : report.curves) {
        chart.title = "Eq. " + equation + ": " + chart.title;
        html += chartHtml(chart);
    }
    return html;
}

std::string verdictOf(const EquationReport& report)
{
    std::size_t broken = 0;
    std::string first;
    for (const EquationCheck& c : report.checks)
        if (!c.holds() && ++broken == 1)
            first =
                "Eq. " + c.equation + ", " + c.function + ": " + shortNumber(c.worst) + " against " + shortNumber(c.bound.value) + " (" + c.bound.name + ")";
    const std::string count = std::to_string(report.checks.size());
    if (broken == 0) return "Equations: all " + count + " bounds hold.";
    return "Equations: " + std::to_string(broken) + " of " + count + " bounds are broken; the first is " + first + ".";
}

}  // namespace

ValidationPart describeEquations(const EquationReport& report, Json& json)
{
    json = equationsJson(report);
    ValidationPart part{"equations", report.holds(), verdictOf(report), {}, {}, {}};
    part.text = textTable(checksForPeople(report, false)) + textTable(tradesForPeople(report));
    part.html = headingHtml("The equations, function by function") + paragraphHtml(part.verdict) + curvesHtml(report) + tableHtml(tradesForPeople(report)) +
                tableHtml(checksForPeople(report, true));
    part.csv = {{"equations.csv", csvTable(checksForPrograms(report))}, {"trades.csv", csvTable(tradesForPrograms(report))}};
    return part;
}

}  // namespace lrsm
