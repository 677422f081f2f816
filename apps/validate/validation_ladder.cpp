#include "apps/validate/validation_report.h"
#include "core/report/chart.h"
#include "core/report/html.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

namespace lrsm {
namespace {

using Json = nlohmann::ordered_json;

/// A ladder with what its page calls things.
struct NamedLadder {
    const char* key;
    const char* title;
    const char* unit;
    const Ladder& ladder;
};

std::vector<NamedLadder> laddersOf(const LadderScene& scene)
{
    std::vector<NamedLadder> ladders = {{"radiance", "Radiance of a cone sample, from Eq. 2 down", "W/(m^2 sr)", scene.radiance},
                                        {"visibility", "Opacity of a cone, from exact rays down", "", scene.visibility}};
    if (!scene.emission.rungs.empty())
        ladders.push_back({"emission", "Emission of a segment of estimator slab, from exact rays down", "W/(m^2 sr)", scene.emission});
    return ladders;
}

std::string fileStem(const std::string& name)
{
    std::string stem;
    for (const char letter : name) stem += std::isalnum(static_cast<unsigned char>(letter)) || letter == '-' || letter == '_' ? letter : '-';
    return stem;
}

ReportTable rungTable(const NamedLadder& named, bool whole)
{
    ReportTable table{named.title, {"rung", "mean", "step mean", "step rms", "p50", "p95", "p99", "max", "to top mean", "to top rms", "share"}, {}};
    if (whole) table.head.insert(table.head.end(), {"to top p50", "to top p95", "to top p99", "to top max", "weighted mean"});
    for (const RungStatistics& rung : named.ladder.rungs) {
        const DifferenceStatistics &step = rung.toAbove, &way = rung.toTop;
        std::vector<std::string> row = {rung.name};
        for (const double value : {rung.mean, step.mean, step.rms, step.p50, step.p95, step.p99, step.max, way.mean, way.rms})
            row.push_back(shortNumber(value));
        row.push_back(shortNumber(100.0 * rung.share) + " %");
        if (whole) {
            for (const double value : {way.p50, way.p95, way.p99, way.max, rung.weightedMean}) row.push_back(shortNumber(value));
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

ReportTable meaningTable(const NamedLadder& named)
{
    ReportTable table{"", {"rung", "what it switches on"}, {}};
    for (const RungStatistics& rung : named.ladder.rungs) table.rows.push_back({rung.name, rung.meaning});
    return table;
}

ReportTable rungsForPrograms(const LadderScene& scene)
{
    ReportTable table{"", {"scene", "ladder", "rung", "mean", "weighted_mean", "share"}, {}};
    for (const char* to : {"above", "top"})
        for (const char* what : {"mean", "rms", "p50", "p95", "p99", "max", "weighted_mean"}) table.head.push_back(std::string(what) + "_to_" + to);
    for (const NamedLadder& named : laddersOf(scene))
        for (const RungStatistics& rung : named.ladder.rungs) {
            std::vector<std::string> row = {scene.scene, named.key, rung.name, exactNumber(rung.mean), exactNumber(rung.weightedMean), exactNumber(rung.share)};
            for (const DifferenceStatistics* d : {&rung.toAbove, &rung.toTop})
                for (const double value : {d->mean, d->rms, d->p50, d->p95, d->p99, d->max, d->weightedMean}) row.push_back(exactNumber(value));
            table.rows.push_back(std::move(row));
        }
    return table;
}

ReportTable samplesForPrograms(const LadderScene& scene)
{
    ReportTable table{
        "",
        {"x", "y", "cone", "step", "centre_x", "centre_y", "centre_z", "radius", "distance", "weight", "level", "slope", "layers", "has_surface", "noise"},
        {}};
    for (const RungInfo& rung : radianceRungs()) table.head.push_back("radiance " + rung.name);
    for (const RungInfo& rung : visibilityRungs()) table.head.push_back("opacity " + rung.name);
    for (const RungInfo& rung : emissionRungs()) table.head.push_back("emission " + rung.name);
    for (const LadderSample& s : scene.samples) {
        std::vector<std::string> row = {std::to_string(s.x), std::to_string(s.y), std::to_string(s.cone), std::to_string(s.step)};
        for (const double value :
             {double(s.centre.x), double(s.centre.y), double(s.centre.z), double(s.radius), double(s.distance), s.weight, s.level, s.slope})
            row.push_back(exactNumber(value));
        row.insert(row.end(), {std::to_string(s.layers), s.hasSurface ? "1" : "0", exactNumber(s.noise)});
        for (const double value : s.radiance) row.push_back(exactNumber(value));
        for (const double value : s.opacity) row.push_back(exactNumber(value));
        for (const double value : s.emission) row.push_back(exactNumber(value));
        table.rows.push_back(std::move(row));
    }
    return table;
}

ReportTable worstTable(const LadderScene& scene, const NamedLadder& named)
{
    ReportTable table{"Worst cases; look at one with: lrsm render SCENE --size " + std::to_string(scene.width) + "x" + std::to_string(scene.height) +
                          " --pixel x,y and the same settings",
                      {"rung", "difference", "pixel", "cone", "step", "r_c", "level", "<n.l>"},
                      {}};
    for (const RungStatistics& rung : named.ladder.rungs) table.head.push_back(rung.name);
    for (const WorstCase& worst : named.ladder.worst) {
        const LadderSample& s = scene.samples[worst.sample];
        std::vector<std::string> row = {worst.toTop ? worst.rung + ", whole way" : worst.rung,
                                        shortNumber(worst.difference),
                                        std::to_string(s.x) + "," + std::to_string(s.y),
                                        std::to_string(s.cone),
                                        std::to_string(s.step),
                                        shortNumber(double(s.radius)),
                                        shortNumber(s.level),
                                        shortNumber(s.slope)};
        const double* values = &named.ladder == &scene.radiance ? s.radiance : &named.ladder == &scene.visibility ? s.opacity : s.emission;
        for (std::size_t i = 0; i < named.ladder.rungs.size(); ++i) row.push_back(shortNumber(values[i]));
        table.rows.push_back(std::move(row));
    }
    return table;
}

BarChart stepsChart(const NamedLadder& named)
{
    BarChart chart{"Where error enters: rms step of each rung, and rms distance to the top", named.unit, {}, {{"step", {}}, {"to the top", {}}}};
    for (const RungStatistics& rung : named.ladder.rungs) {
        chart.categories.push_back(rung.name);
        chart.series[0].values.push_back(rung.toAbove.rms);
        chart.series[1].values.push_back(rung.toTop.rms);
    }
    return chart;
}

Chart distributionChart(const NamedLadder& named)
{
    Chart chart{"Distribution of each rung's step",
                std::string("difference to the rung above") + (*named.unit ? ", " : "") + named.unit,
                "share of the samples",
                false,
                true,
                {}};
    const std::vector<double>& edges = named.ladder.histogramEdges;
    for (std::size_t r = 1; r < named.ladder.rungs.size(); ++r) {
        const RungStatistics& rung = named.ladder.rungs[r];
        ChartSeries series{.label = rung.name, .x = {}, .y = {}};
        for (std::size_t i = 0; i + 1 < edges.size() && i < rung.toAbove.histogram.size(); ++i) {
            series.x.push_back(0.5 * (edges[i] + edges[i + 1]));
            series.y.push_back(static_cast<double>(rung.toAbove.histogram[i]) / static_cast<double>(std::max<std::size_t>(named.ladder.samples, 1)));
        }
        chart.series.push_back(std::move(series));
    }
    return chart;
}

Chart curveChart(const NamedLadder& named, const LadderCurve& curve)
{
    const bool distance = curve.variable == "r_c" || curve.variable == "distance";
    Chart chart{"Error against " + curve.variable, curve.variable + (curve.unit.empty() ? "" : ", " + curve.unit), "rms step", distance, false, {}};
    for (std::size_t r = 1; r < named.ladder.rungs.size(); ++r) {
        ChartSeries series{.label = named.ladder.rungs[r].name, .x = {}, .y = {}};
        for (const CurveBin& bin : curve.bins) {
            series.x.push_back(distance ? std::max(bin.low, 0.1 * bin.high) : 0.5 * (bin.low + bin.high));
            series.y.push_back(bin.rmsToAbove[r]);
        }
        chart.series.push_back(std::move(series));
    }
    return chart;
}

std::string sceneHtml(const LadderScene& scene)
{
    std::string html = headingHtml("Error ladder: " + scene.scene) + paragraphHtml(scene.verdict);
    html +=
        paragraphHtml(std::to_string(scene.samples.size()) + " of " + std::to_string(scene.lookups) + " lookups of a frame of " + std::to_string(scene.width) +
                      "x" + std::to_string(scene.height) + ", each with the same probability; " + std::to_string(scene.withoutSurface) +
                      " of them have no surface in their sphere, where Eq. 2 is undefined: they bring " + shortNumber(100.0 * scene.lightFromNothing) +
                      " % of the light. Sampling noise of the top rung: " + shortNumber(scene.noise) + " rms.");
    for (const std::string& note : scene.notes) html += paragraphHtml(note);
    for (const NamedLadder& named : laddersOf(scene)) {
        html += tableHtml(rungTable(named, true)) + foldedHtml("What each rung switches on", tableHtml(meaningTable(named))) + chartHtml(stepsChart(named)) +
                chartHtml(distributionChart(named));
        for (const LadderCurve& curve : named.ladder.curves) html += chartHtml(curveChart(named, curve));
        html += foldedHtml("Worst cases: " + std::string(named.key), tableHtml(worstTable(scene, named)));
    }
    return html;
}

Json differenceJson(const DifferenceStatistics& d)
{
    return {{"mean", d.mean},
            {"rms", d.rms},
            {"p50", d.p50},
            {"p95", d.p95},
            {"p99", d.p99},
            {"max", d.max},
            {"weightedMean", d.weightedMean},
            {"quantiles", d.quantiles},
            {"histogram", d.histogram}};
}

Json ladderJson(const LadderScene& scene, const NamedLadder& named)
{
    Json rungs = Json::array(), worst = Json::array(), curves = Json::array();
    for (const RungStatistics& r : named.ladder.rungs)
        rungs.push_back({{"name", r.name},
                         {"meaning", r.meaning},
                         {"mean", r.mean},
                         {"weightedMean", r.weightedMean},
                         {"share", r.share},
                         {"toAbove", differenceJson(r.toAbove)},
                         {"toTop", differenceJson(r.toTop)}});
    for (const WorstCase& w : named.ladder.worst) {
        const LadderSample& s = scene.samples[w.sample];
        worst.push_back({{"rung", w.rung}, {"toTop", w.toTop}, {"difference", w.difference}, {"pixel", {s.x, s.y}}, {"cone", s.cone}, {"step", s.step}});
    }
    for (const LadderCurve& c : named.ladder.curves) {
        Json bins = Json::array();
        for (const CurveBin& b : c.bins)
            bins.push_back({{"low", b.low},
                            {"high", b.high},
                            {"count", b.count},
                            {"meanToAbove", b.meanToAbove},
                            {"rmsToAbove", b.rmsToAbove},
                            {"meanToTop", b.meanToTop},
                            {"rmsToTop", b.rmsToTop}});
        curves.push_back({{"variable", c.variable}, {"unit", c.unit}, {"bins", std::move(bins)}});
    }
    return {{"samples", named.ladder.samples},
            {"verdict", named.ladder.verdict},
            {"probabilities", ladderProbabilities()},
            {"histogramEdges", named.ladder.histogramEdges},
            {"rungs", std::move(rungs)},
            {"curves", std::move(curves)},
            {"worst", std::move(worst)}};
}

Json sceneLadderJson(const LadderScene& scene)
{
    Json json = {{"scene", scene.scene},
                 {"size", {scene.width, scene.height}},
                 {"samples", scene.samples.size()},
                 {"lookups", scene.lookups},
                 {"withoutSurface", scene.withoutSurface},
                 {"lightFromNothing", scene.lightFromNothing},
                 {"noise", scene.noise},
                 {"notes", scene.notes}};
    for (const NamedLadder& named : laddersOf(scene)) json[named.key] = ladderJson(scene, named);
    return json;
}

}  // namespace

ValidationPart describeLadders(const std::vector<LadderScene>& scenes, Json& json)
{
    ValidationPart part{"ladder", true, "", "", "", {}};
    json = Json::array();
    for (const LadderScene& scene : scenes) {
        json.push_back(sceneLadderJson(scene));
        part.verdict += (part.verdict.empty() ? "" : "\n") + scene.verdict;
        part.text += "\nerror ladder of " + scene.scene + ", " + std::to_string(scene.samples.size()) + " cone samples\n";
        for (const NamedLadder& named : laddersOf(scene)) part.text += textTable(rungTable(named, false));
        part.html += sceneHtml(scene);
        part.csv.emplace_back("ladder-" + fileStem(scene.scene) + ".csv", csvTable(rungsForPrograms(scene)));
        part.csv.emplace_back("samples-" + fileStem(scene.scene) + ".csv", csvTable(samplesForPrograms(scene)));
    }
    return part;
}

}  // namespace lrsm
