#include "apps/validate/validation_report.h"
#include "core/report/chart.h"
#include "core/report/html.h"

#include <array>
#include <nlohmann/json.hpp>

namespace lrsm {
namespace {

using Json = nlohmann::ordered_json;

std::string nameOf(Outcome outcome)
{
    switch (outcome) {
    case Outcome::held: return "held";
    case Outcome::refused: return "refused";
    case Outcome::skipped: return "skipped";
    default: return "broken";
    }
}

std::vector<std::string> rowOf(const ExtremeResult& r, bool mark)
{
    return {(mark && r.outcome == Outcome::broken ? "!" : "") + r.group, r.name, r.storage, nameOf(r.outcome), r.what, r.mustHold, r.detail};
}

ReportTable resultsTable(const ExtremesReport& report, bool mark)
{
    ReportTable table{"Every case", {"group", "case", "storage", "outcome", "what is done", "what must hold", "found"}, {}};
    for (const ExtremeResult& r : report.results) table.rows.push_back(rowOf(r, mark));
    return table;
}

/// For a terminal: counts a group, then what broke or was skipped.
std::string resultsText(const ExtremesReport& report)
{
    ReportTable counts{"Extremes", {"group", "held", "refused", "skipped", "broken"}, {}};
    std::vector<std::array<std::size_t, 4>> sums;
    for (const ExtremeResult& r : report.results) {
        std::size_t at = 0;
        while (at < counts.rows.size() && counts.rows[at][0] != r.group) ++at;
        if (at == counts.rows.size()) counts.rows.push_back({r.group}), sums.push_back({});
        ++sums[at][static_cast<std::size_t>(r.outcome)];
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        for (const std::size_t n : sums[i]) counts.rows[i].push_back(std::to_string(n));

    ReportTable notable{"Not held", {"group", "case", "storage", "outcome", "found"}, {}};
    for (const ExtremeResult& r : report.results)
        if (r.outcome == Outcome::broken || r.outcome == Outcome::skipped) notable.rows.push_back({r.group, r.name, r.storage, nameOf(r.outcome), r.detail});

    std::string text = textTable(counts) + textTable(notable);
    for (const ExtremeCurve& curve : report.curves) text += "  " + curve.name + ": " + curve.sentence + "\n";
    return text;
}

Json extremesJson(const ExtremesReport& report)
{
    Json results = Json::array(), curves = Json::array();
    for (const ExtremeResult& r : report.results)
        results.push_back({{"name", r.name},
                           {"group", r.group},
                           {"what", r.what},
                           {"mustHold", r.mustHold},
                           {"storage", r.storage},
                           {"outcome", nameOf(r.outcome)},
                           {"detail", r.detail}});
    for (const ExtremeCurve& c : report.curves) {
        Json series = Json::array();
        for (const ChartSeries& s : c.series) series.push_back({{"label", s.label}, {"x", s.x}, {"y", s.y}});
        curves.push_back({{"name", c.name},
                          {"xLabel", c.xLabel},
                          {"yLabel", c.yLabel},
                          {"bound", c.bound},
                          {"degradesFrom", c.degradesFrom},
                          {"degradesDownwards", c.degradesDownwards},
                          {"sentence", c.sentence},
                          {"series", std::move(series)}});
    }
    return {{"results", std::move(results)}, {"curves", std::move(curves)}};
}

std::string curvesHtml(const ExtremesReport& report)
{
    std::string html;
    for (const ExtremeCurve& curve : report.curves) {
        Chart chart{curve.name + ": " + curve.sentence, curve.xLabel, curve.yLabel, true, true, curve.series};
        if (!curve.series.empty() && !curve.series.front().x.empty() && curve.bound > 0.0) {
            const std::vector<double>& x = curve.series.front().x;
            chart.series.push_back({.label = "bound", .x = {x.front(), x.back()}, .y = {curve.bound, curve.bound}, .dashed = true});
        }
        html += chartHtml(chart);
    }
    return html;
}

std::string verdictOf(const ExtremesReport& report)
{
    std::array<std::size_t, 4> counts{};
    for (const ExtremeResult& r : report.results) ++counts[static_cast<std::size_t>(r.outcome)];
    std::string text = "Extremes: " + std::to_string(report.results.size()) + " cases: " + std::to_string(counts[0]) + " held, " + std::to_string(counts[1]) +
                       " refused with a clear line";
    if (counts[2]) text += ", " + std::to_string(counts[2]) + " skipped";
    return text + ", " + std::to_string(counts[3]) + " broken.";
}

}  // namespace

ValidationPart describeExtremes(const ExtremesReport& report, Json& json)
{
    json = extremesJson(report);
    ValidationPart part{"extremes", report.held(), verdictOf(report), {}, {}, {}};
    part.text = resultsText(report);
    part.html = headingHtml("The extremes") + paragraphHtml(part.verdict) + curvesHtml(report) + tableHtml(resultsTable(report, true));
    part.csv = {{"extremes.csv", csvTable(resultsTable(report, false))}};
    return part;
}

}  // namespace lrsm
