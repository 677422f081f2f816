#include "apps/sweep/sweep_tables.h"

#include "core/base/text.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace {

std::string megabytes(std::size_t bytes)
{
    return bytes ? plainNumber(static_cast<double>(bytes) / 1e6) : "";
}

std::string changeText(double change)
{
    return (change > 0.0 ? "+" : "") + shortNumber(100.0 * change);
}

std::string_view nameOf(EffectKind kind)
{
    switch (kind) {
    case EffectKind::winsBoth: return "wins both";
    case EffectKind::buys: return "buys accuracy";
    case EffectKind::saves: return "saves time";
    case EffectKind::losesBoth: return "loses both";
    case EffectKind::changesNothing: break;
    }
    return "changes nothing";
}

/// What is saved in memory alone is worth having, where a GPU is short of it.
bool savesMemory(const Effect& effect)
{
    return effect.bytes < -0.01;
}

std::vector<std::string> effectRow(const Effect& e)
{
    const bool useless = e.kind == EffectKind::losesBoth && !savesMemory(e);
    const std::string verdict = std::string(nameOf(e.kind)) + (e.kind == EffectKind::losesBoth && savesMemory(e) ? ", saves memory" : "");
    return {(useless ? "!" : "") + e.label,
            e.base,
            verdict,
            e.percentPerMs > 0.0 ? shortNumber(e.percentPerMs) : "",
            changeText(e.error),
            changeText(e.worstError),
            changeText(e.cost),
            (e.milliseconds > 0.0 ? "+" : "") + shortNumber(e.milliseconds),
            changeText(e.bytes),
            std::to_string(e.changed) + " of " + std::to_string(e.cases)};
}

std::string errorText(const Looked& looked, const std::string& end)
{
    switch (looked.reach) {
    case Reach::measured: return shortNumber(100.0 * looked.value);
    case Reach::before: return "> " + shortNumber(100.0 * looked.value) + end;
    case Reach::beyond: return "< " + shortNumber(100.0 * looked.value);
    case Reach::belowFloor: break;
    }
    return "<= floor";
}

std::string costText(const Looked& looked)
{
    switch (looked.reach) {
    case Reach::measured: return plainNumber(looked.value);
    case Reach::before: return "< " + plainNumber(looked.value);
    case Reach::beyond: return "> " + plainNumber(looked.value);
    case Reach::belowFloor: break;
    }
    return "<= floor";
}

std::string spanText(const std::vector<double>& values)
{
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return shortNumber(*least) + " .. " + shortNumber(*most);
}

std::string ratioText(const std::optional<double>& ratio)
{
    return ratio ? shortNumber(*ratio) : "";
}

}  // namespace

std::string percentText(double ratio)
{
    return shortNumber(100.0 * ratio) + " %";
}

std::string plainNumber(double value)
{
    return value >= 1000.0 && value < 1e7 ? std::to_string(std::llround(value)) : shortNumber(value);
}

std::string changedText(const Measurement& row)
{
    if (row.kind == RowKind::pathTracer) return std::to_string(row.samples) + (row.samples == 1 ? " path a pixel" : " paths a pixel");
    const std::vector<SettingDifference> changes = differences(Settings{}, row.settings);
    return changes.empty() ? "nothing" : joined(changes, [](const SettingDifference& d) { return d.key + "=" + d.b; });
}

ReportTable casesTable(const std::vector<CaseRows>& cases)
{
    ReportTable table{
        "Scenes", {"scene", "size", "settings", "path tracer, spp", "truth, spp", "noise floor, %", "balanced: error, %", "frames", "ms", "MB"}, {}};
    for (const CaseRows& one : cases) {
        const Measurement& any = one.settings.empty() ? *one.pathTracer.front() : *one.settings.front();
        std::vector<std::string> row = {one.name,
                                        std::to_string(any.width) + " x " + std::to_string(any.height),
                                        std::to_string(one.settings.size()),
                                        one.pathTracer.empty() ? "none" : "1 .. " + std::to_string(one.pathTracer.back()->samples),
                                        std::to_string(any.truthSamples),
                                        shortNumber(100.0 * any.error.noise)};
        if (const Measurement* balanced = findSettings(one, Settings{}))
            row.insert(row.end(), {shortNumber(100.0 * balanced->error.net()), plainNumber(balanced->cost), plainNumber(balanced->frame.median),
                                   megabytes(balanced->bytes)});
        table.rows.push_back(std::move(row));
    }
    return table;
}

ReportTable effectsTable(const std::vector<Effect>& effects)
{
    ReportTable table{"One setting at a time",
                      {"value", "around", "verdict", "% of error a ms", "error, %", "worst scene, %", "time, %", "ms", "memory, %", "scenes changed"},
                      {}};
    for (const Effect& e : effects)
        if (e.kind != EffectKind::changesNothing) table.rows.push_back(effectRow(e));
    return table;
}

ReportTable nothingTable(const std::vector<Effect>& effects)
{
    ReportTable table{"Changes nothing", {"value", "around", "scenes", "time, %", "memory, %"}, {}};
    for (const Effect& e : effects)
        if (e.kind == EffectKind::changesNothing) table.rows.push_back({e.label, e.base, std::to_string(e.cases), changeText(e.cost), changeText(e.bytes)});
    return table;
}

ReportTable equalSummaryTable(const std::vector<EqualSummary>& presets)
{
    ReportTable table{"Path tracer over preset: geometric means over the scenes that have the ratio",
                      {"preset", "error at equal time", "scenes", "time at equal error", "scenes"},
                      {}};
    for (const EqualSummary& p : presets)
        table.rows.push_back({p.preset, p.errorRatios ? shortNumber(p.errorRatio) : "", std::to_string(p.errorRatios) + " of " + std::to_string(p.cases),
                              p.costRatios ? shortNumber(p.costRatio) : "", std::to_string(p.costRatios) + " of " + std::to_string(p.cases)});
    return table;
}

ReportTable presetsTable(const std::vector<EqualRow>& rows)
{
    ReportTable table{"Presets, scene by scene",
                      {"scene", "preset", "energy", "error, %", "MAE, %", "FLIP", "frames", "over balanced's", "MB", "path tracer in its time: error, %",
                       "over the preset's", "path tracer for its error: frames", "over the preset's"},
                      {}};
    for (const EqualRow& r : rows) {
        const Measurement& row = *r.row;
        table.rows.push_back({r.name, row.label, shortNumber(row.error.energy), r.atFloor ? "<= floor" : shortNumber(100.0 * row.error.net()),
                              shortNumber(100.0 * row.error.mae), shortNumber(row.error.flip), plainNumber(row.cost),
                              r.balanced ? shortNumber(row.cost / r.balanced->cost) : "", megabytes(row.bytes), errorText(r.tracerError, " (1 spp is dearer)"),
                              ratioText(r.errorRatio), costText(r.tracerCost), ratioText(r.costRatio)});
    }
    return table;
}

ReportTable frontTable(const std::string& title, const std::vector<const Measurement*>& front)
{
    ReportTable table{title, {"frames", "ms", "error, %", "FLIP", "energy", "MB", "settings against balanced"}, {}};
    for (const Measurement* row : front)
        table.rows.push_back({plainNumber(row->cost), plainNumber(row->frame.median),
                              row->error.net() <= row->error.noise ? "<= floor" : shortNumber(100.0 * row->error.net()), shortNumber(row->error.flip),
                              shortNumber(row->error.energy), megabytes(row->bytes), changedText(*row)});
    return table;
}

ReportTable combinedTable(const CombinedCases& all)
{
    ReportTable table{"All scenes: over balanced", {"settings", "time", "error", "energy", "memory", "on the front"}, {}};
    for (const CaseRows* one : all.cases) table.head.push_back(one->name + ": error");
    const std::vector<const CombinedRow*> front = combinedFront(all);
    std::vector<const CombinedRow*> rows;
    for (const CombinedRow& row : all.settings) rows.push_back(&row);
    std::stable_sort(rows.begin(), rows.end(), [](const CombinedRow* a, const CombinedRow* b) { return a->cost < b->cost; });
    for (const CombinedRow* row : rows) {
        std::vector<double> costs, errors, energies;
        for (std::size_t i = 0; i < row->rows.size(); ++i) {
            costs.push_back(row->relative[i].cost);
            errors.push_back(row->relative[i].error);
            energies.push_back(row->rows[i]->error.energy);
        }
        std::vector<std::string> cells = {row->rows.front()->label,
                                          shortNumber(row->cost) + " (" + spanText(costs) + ")",
                                          shortNumber(row->error) + " (" + spanText(errors) + ")",
                                          spanText(energies),
                                          shortNumber(row->bytes),
                                          std::find(front.begin(), front.end(), row) == front.end() ? "" : "yes"};
        for (const double error : errors) cells.push_back(shortNumber(error));
        table.rows.push_back(std::move(cells));
    }
    return table;
}

}  // namespace lrsm
