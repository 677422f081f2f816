#include "apps/tune/tune_report.h"

#include "apps/sweep/sweep_tables.h"
#include "core/report/table.h"
#include "core/settings/settings_table.h"

#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using TuneJson = nlohmann::ordered_json;

const char* metricName(TuneMetric metric)
{
    return metric == TuneMetric::flip ? "flip" : metric == TuneMetric::energy ? "energy" : "rmse";
}

const char* metricWords(TuneMetric metric)
{
    return metric == TuneMetric::flip ? "FLIP" : metric == TuneMetric::energy ? "|energy - 1|" : "net RMSE / mean";
}

std::string budgetText(const TuneBudget& budget)
{
    std::string text;
    const auto add = [&](const std::optional<double>& value, const std::string& before, const std::string& unit) {
        if (value) text += (text.empty() ? "" : ", ") + before + " <= " + plainNumber(*value) + unit;
    };
    add(budget.error, metricWords(budget.metric), "");
    add(budget.milliseconds, "time", " ms");
    add(budget.cost, "time", " calibration frames");
    add(budget.megabytes, "memory", " MB");
    return text;
}

/// As predicted from the probe alone.
std::optional<TuneFigures> predicted(const TunePoint& point, const TuneRecord& record)
{
    TunePoint unverified = point;
    unverified.verified.reset();
    return figuresOf(unverified, record.request, {}, record.result.scale);
}

std::optional<TuneFigures> verified(const TunePoint& point, const TuneRecord& record)
{
    return point.verified ? figuresOf(point, record.request, {}, record.result.scale) : std::nullopt;
}

TuneJson figuresJson(const std::optional<TuneFigures>& figures)
{
    if (!figures) return nullptr;
    return {{"error", figures->error}, {"cost", figures->cost}, {"milliseconds", figures->milliseconds}, {"megabytes", figures->megabytes}};
}

TuneJson limitJson(const std::optional<double>& limit)
{
    return limit ? TuneJson(*limit) : TuneJson(nullptr);
}

TuneJson pointJson(const TunePoint& point, const TuneRecord& record)
{
    TuneJson json = {{"name", point.named.label},
                     {"megabytes", point.megabytes},
                     {"predicted", figuresJson(predicted(point, record))},
                     {"verified", figuresJson(verified(point, record))}};
    if (point.verified) {
        json["verified"]["measured_milliseconds"] = point.verified->frame.median;
        json["verified"]["energy"] = point.verified->error.energy;
        json["verified"]["rmse"] = point.verified->error.net();
        json["verified"]["flip"] = point.verified->error.flip;
    }
    if (!point.skipped.empty()) json["not_probed"] = point.skipped;
    TuneJson changes = TuneJson::object();
    for (const SettingDifference& change : differences(preset("balanced"), point.named.settings)) changes[change.key] = change.b;
    json["changes"] = changes;
    if (!point.trimmed.empty()) json["trimmed"] = point.trimmed;
    return json;
}

std::vector<std::string> tableRow(const TunePoint& point, bool chosen, const TuneRecord& record)
{
    const auto before = predicted(point, record), after = verified(point, record);
    const auto text = [](const std::optional<TuneFigures>& figures, double TuneFigures::*field) {
        return figures ? plainNumber((*figures).*field) : std::string();
    };
    return {chosen ? "->" : "",
            point.named.label,
            text(before, &TuneFigures::error),
            text(before, &TuneFigures::milliseconds),
            text(before, &TuneFigures::cost),
            plainNumber(point.megabytes),
            text(after, &TuneFigures::error),
            text(after, &TuneFigures::milliseconds),
            point.skipped};
}

std::string sentence(const TunePoint& point, const TuneRecord& record)
{
    const auto words = [](const TuneFigures& f) { return "error " + plainNumber(f.error) + ", " + plainNumber(f.milliseconds) + " ms"; };
    std::string text = point.named.label + ", " + plainNumber(point.megabytes) + " MB";
    if (const auto before = predicted(point, record)) text += "; predicted " + words(*before);
    if (const auto after = verified(point, record))
        text += "; verified " + words(*after) + " (this run took " + plainNumber(point.verified->frame.median) + " ms)";
    return text;
}

}  // namespace

TuneJson tuneJson(const TuneRecord& record, std::optional<std::size_t> written)
{
    const TuneRequest& request = record.request;
    const TuneResult& result = record.result;
    TuneJson json = TuneJson::object();
    if (written) json["settings"] = settingsToJson(result.points[*written].named.settings);
    TuneJson& tune = json["tune"];
    tune["scene"] = record.scene;
    tune["size"] = {request.width, request.height};
    tune["budget"] = {{"metric", metricName(request.budget.metric)},
                      {"max_error", limitJson(request.budget.error)},
                      {"max_milliseconds", limitJson(request.budget.milliseconds)},
                      {"max_calibration_frames", limitJson(request.budget.cost)},
                      {"max_megabytes", limitJson(request.budget.megabytes)}};
    tune["met"] = result.chosen.has_value();
    tune["chosen"] = result.chosen ? TuneJson(result.points[*result.chosen].named.label) : TuneJson(nullptr);
    tune["nearest"] = result.nearest ? TuneJson(result.points[*result.nearest].named.label) : TuneJson(nullptr);
    tune["truth"] = {{"probe_size", {record.probeSize.x, record.probeSize.y}}, {"probe_spp", record.probeSamples}, {"probe_noise", record.probeNoise}};
    if (record.verifySamples > 0) {
        tune["truth"]["verify_spp"] = record.verifySamples;
        tune["truth"]["verify_noise"] = record.verifyNoise;
    }
    tune["calibration"] = {{"cpu_milliseconds", result.scale.calibrationCpu}, {"wall_per_cpu", result.scale.wallPerCpu}};
    tune["correction"] = {{"error", result.correction.error}, {"cost", result.correction.cost}};
    for (const TunePoint& point : result.points) tune["points"].push_back(pointJson(point, record));
    return json;
}

void printTune(std::ostream& out, const TuneRecord& record, const std::string& file)
{
    const TuneRequest& request = record.request;
    const TuneResult& result = record.result;
    out << record.scene << " at " << request.width << "x" << request.height << ": " << budgetText(request.budget) << "\n"
        << "error: " << metricWords(request.budget.metric) << " of the irradiance; the truth of the probes (" << record.probeSize.x << "x" << record.probeSize.y
        << ", " << record.probeSamples << " spp) has noise " << plainNumber(record.probeNoise);
    if (record.verifySamples > 0) out << ", that of the verification (" << record.verifySamples << " spp) " << plainNumber(record.verifyNoise);
    out << "\ntime: one calibration frame is " << plainNumber(result.scale.calibrationCpu) << " ms of processor time; wall time is "
        << plainNumber(result.scale.wallPerCpu) << " of a frame's processor time\n\n";

    ReportTable table{"", {"", "settings", "error", "ms", "cal. frames", "MB", "error, verified", "ms, verified", "not probed"}, {}};
    const std::optional<std::size_t> marked = result.chosen ? result.chosen : result.nearest;
    for (std::size_t i = 0; i < result.points.size(); ++i) table.rows.push_back(tableRow(result.points[i], marked == i, record));
    out << textTable(table) << "\n";

    if (result.chosen) {
        out << "chosen: " << sentence(result.points[*result.chosen], record) << "\n";
    } else {
        out << "no settings meet this budget.\n";
        if (result.nearest) out << "nearest: " << sentence(result.points[*result.nearest], record) << "\n";
        if (result.nearest && file.empty()) out << "nothing was written; --nearest writes the nearest\n";
    }
    if (marked)
        for (const std::string& change : result.points[*marked].trimmed) out << "  not required here: " << change << "\n";
    if (!file.empty()) out << file << ": for --settings\n";
}

}  // namespace lrsm
