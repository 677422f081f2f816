#include "apps/sweep/rivals.h"

#include <algorithm>

namespace lrsm {
namespace {

EqualRow equalRow(const CaseRows& rows, const Measurement& row)
{
    const std::vector<CostError> curve = pathTracerCurve(rows);
    const double floor = row.error.noise;
    const double error = row.error.net();
    EqualRow equal{.name = rows.name,
                   .row = &row,
                   .balanced = findSettings(rows, Settings{}),
                   .atFloor = error <= floor,
                   .tracerError = errorAt(curve, row.cost, floor),
                   .tracerCost = costAt(curve, error, floor),
                   .errorRatio = {},
                   .costRatio = {}};
    if (equal.atFloor) return equal;
    if (equal.tracerError.reach == Reach::measured) equal.errorRatio = equal.tracerError.value / error;
    if (equal.tracerCost.reach == Reach::measured) equal.costRatio = equal.tracerCost.value / row.cost;
    return equal;
}

}  // namespace

Looked errorAt(const std::vector<CostError>& curve, double cost, double floor)
{
    if (curve.empty()) return {Reach::beyond, 0.0};
    if (cost < curve.front().cost) return {Reach::before, curve.front().error};
    // Beyond the curve's end an error is only known to be no larger than the last one.
    if (cost > curve.back().cost) return curve.back().error <= floor ? Looked{Reach::belowFloor, floor} : Looked{Reach::beyond, curve.back().error};
    const std::optional<double> error = errorAtCost(curve, cost);
    if (!error) return {Reach::before, curve.front().error};
    return *error <= floor ? Looked{Reach::belowFloor, floor} : Looked{Reach::measured, *error};
}

Looked costAt(const std::vector<CostError>& curve, double error, double floor)
{
    if (error <= floor) return {Reach::belowFloor, floor};
    if (curve.empty()) return {Reach::beyond, 0.0};
    if (curve.front().error < error) return {Reach::before, curve.front().cost};
    const std::optional<double> cost = costAtError(curve, error);
    return cost ? Looked{Reach::measured, *cost} : Looked{Reach::beyond, curve.back().cost};
}

std::vector<EqualRow> presetsAgainstPathTracer(const std::vector<CaseRows>& cases)
{
    std::vector<EqualRow> all;
    for (const CaseRows& one : cases)
        for (const Measurement* row : one.settings)
            if (row->kind == RowKind::preset && !one.pathTracer.empty()) all.push_back(equalRow(one, *row));
    return all;
}

std::vector<EqualSummary> summarizeEqual(const std::vector<EqualRow>& rows)
{
    std::vector<EqualSummary> all;
    for (const EqualRow& first : rows) {
        if (std::any_of(all.begin(), all.end(), [&](const EqualSummary& s) { return s.preset == first.row->label; })) continue;
        EqualSummary summary{.preset = first.row->label};
        std::vector<double> errors, costs;
        for (const EqualRow& row : rows) {
            if (row.row->label != first.row->label) continue;
            ++summary.cases;
            if (row.errorRatio) errors.push_back(*row.errorRatio);
            if (row.costRatio) costs.push_back(*row.costRatio);
        }
        summary.errorRatios = errors.size();
        summary.costRatios = costs.size();
        if (!errors.empty()) summary.errorRatio = geometricMean(errors);
        if (!costs.empty()) summary.costRatio = geometricMean(costs);
        all.push_back(summary);
    }
    return all;
}

}  // namespace lrsm
