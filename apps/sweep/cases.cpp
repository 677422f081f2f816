#include "apps/sweep/cases.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace {

/// Names stay unique: "box", or "box 320x180 0123456789abcdef" where another case is called "box" too.
void nameApart(std::vector<CaseRows>& cases)
{
    const std::vector<CaseRows> before = cases;
    for (CaseRows& one : cases) {
        const auto same = std::count_if(before.begin(), before.end(), [&](const CaseRows& other) { return other.name == one.name; });
        const Measurement& row = one.settings.empty() ? *one.pathTracer.front() : *one.settings.front();
        if (same > 1) one.name += " " + std::to_string(row.width) + "x" + std::to_string(row.height) + " " + one.caseKey;
    }
}

std::vector<const Measurement*> frontOf(const CaseRows& rows, double (*costOf)(const Measurement&))
{
    std::vector<CostError> points;
    for (const Measurement* row : rows.settings) points.push_back({costOf(*row), row->error.net()});
    std::vector<const Measurement*> front;
    for (const std::size_t i : paretoFront(points)) front.push_back(rows.settings[i]);
    return front;
}

/// A row without figures to take a ratio of takes no part.
bool comparable(const Measurement& row)
{
    return std::isfinite(row.error.net()) && std::isfinite(row.cost) && row.error.net() >= 0.0 && row.cost > 0.0;
}

CombinedRow combinedOf(const std::vector<const Measurement*>& rows, const std::vector<const Measurement*>& base)
{
    std::vector<CostError> scenes;
    std::vector<double> bytes;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        scenes.push_back(relativeTo(*rows[i], *base[i]));
        if (rows[i]->bytes > 0 && base[i]->bytes > 0) bytes.push_back(static_cast<double>(rows[i]->bytes) / static_cast<double>(base[i]->bytes));
    }
    const CostError all = combineScenes(scenes);
    return {.rows = rows, .relative = scenes, .error = all.error, .cost = all.cost, .bytes = geometricMean(bytes)};
}

const Measurement* findSamples(const CaseRows& rows, std::uint64_t samples)
{
    for (const Measurement* row : rows.pathTracer)
        if (row->samples == samples) return row;
    return nullptr;
}

/// For each row of the first case, the same row of each case, where all have it.
template <typename Find>
std::vector<CombinedRow> combineRows(const std::vector<const CaseRows*>& cases, const std::vector<const Measurement*>& base,
                                     const std::vector<const Measurement*>& first, const Find& find)
{
    std::vector<CombinedRow> combined;
    for (const Measurement* row : first) {
        std::vector<const Measurement*> rows;
        for (const CaseRows* one : cases)
            if (const Measurement* same = find(*one, *row); same && comparable(*same)) rows.push_back(same);
        if (rows.size() == cases.size()) combined.push_back(combinedOf(rows, base));
    }
    return combined;
}

}  // namespace

std::vector<CaseRows> casesOf(const std::vector<Measurement>& rows)
{
    std::vector<CaseRows> cases;
    for (const Measurement& row : rows) {
        auto found = std::find_if(cases.begin(), cases.end(), [&](const CaseRows& one) { return one.caseKey == row.caseKey; });
        if (found == cases.end()) found = cases.insert(cases.end(), CaseRows{row.scene, row.caseKey, {}, {}});
        (row.kind == RowKind::pathTracer ? found->pathTracer : found->settings).push_back(&row);
    }
    for (CaseRows& one : cases)
        std::stable_sort(one.pathTracer.begin(), one.pathTracer.end(), [](const auto* a, const auto* b) { return a->samples < b->samples; });
    nameApart(cases);
    return cases;
}

const Measurement* findSettings(const CaseRows& rows, const Settings& settings)
{
    for (const Measurement* row : rows.settings)
        if (row->settings == settings) return row;
    return nullptr;
}

std::vector<const Measurement*> timeFront(const CaseRows& rows)
{
    return frontOf(rows, [](const Measurement& row) { return row.cost; });
}

std::vector<const Measurement*> memoryFront(const CaseRows& rows)
{
    return frontOf(rows, [](const Measurement& row) { return static_cast<double>(row.bytes); });
}

CostError relativeTo(const Measurement& row, const Measurement& baseline)
{
    constexpr double kLeastError = 1e-6;
    return {row.cost / baseline.cost, std::max(row.error.net(), kLeastError) / std::max(baseline.error.net(), kLeastError)};
}

std::vector<CostError> pathTracerCurve(const CaseRows& rows)
{
    std::vector<CostError> curve;
    for (const Measurement* row : rows.pathTracer) curve.push_back({row->cost, row->error.net()});
    std::stable_sort(curve.begin(), curve.end(), [](const CostError& a, const CostError& b) { return a.cost < b.cost; });
    return curve;
}

CombinedCases combineCases(const std::vector<CaseRows>& cases)
{
    CombinedCases all;
    std::vector<const Measurement*> base;
    std::vector<double> noise;
    for (const CaseRows& one : cases)
        if (const Measurement* balanced = findSettings(one, Settings{}); balanced && comparable(*balanced)) {
            all.cases.push_back(&one);
            base.push_back(balanced);
            if (balanced->error.noise > 0.0 && balanced->error.net() > 0.0) noise.push_back(balanced->error.noise / balanced->error.net());
        }
    if (all.cases.empty()) return all;
    all.settings =
        combineRows(all.cases, base, all.cases.front()->settings, [](const CaseRows& one, const Measurement& row) { return findSettings(one, row.settings); });
    all.pathTracer =
        combineRows(all.cases, base, all.cases.front()->pathTracer, [](const CaseRows& one, const Measurement& row) { return findSamples(one, row.samples); });
    all.noise = noise.empty() ? 0.0 : geometricMean(noise);
    return all;
}

std::vector<const CombinedRow*> combinedFront(const CombinedCases& all)
{
    std::vector<CostError> points;
    for (const CombinedRow& row : all.settings) points.push_back({row.cost, row.error});
    std::vector<const CombinedRow*> front;
    for (const std::size_t i : paretoFront(points)) front.push_back(&all.settings[i]);
    return front;
}

}  // namespace lrsm
