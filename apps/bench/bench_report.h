#pragma once

#include "apps/bench/scaling.h"
#include "core/report/table.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

/// What `lrsm bench` says of its frames: rows, tables, plots.
namespace lrsm {

/// An axis with what was measured on it.
struct MeasuredAxis {
    ScalingAxis axis;
    ScalingResult result;
    std::vector<std::string> leftOut;
};

/// The machine that measured: processor, cores, compiler, load average (1, 5, 15 minutes).
nlohmann::ordered_json machineJson();

/// One frame of bench.csv: its place on the axis, and what was measured.
struct BenchRow {
    std::vector<std::string> place;  ///< axis, x, label, repeat, width, height, threads
    ScalingSample sample;
};
BenchRow benchRow(const ScalingAxis& axis, const ScalingSample& sample);
/// Every series of any row is a column.
ReportTable benchTable(const std::vector<BenchRow>& rows);

/// Median times of a frame and its largest passes, and the work, a row a point; last, the power of x that each grows with.
ReportTable pointTable(const MeasuredAxis& measured);

nlohmann::ordered_json benchJson(const std::vector<MeasuredAxis>& axes, const nlohmann::ordered_json& machine, int repeat);
/// Self-contained: one log-log plot and table an axis.
std::string benchPage(const std::vector<MeasuredAxis>& axes, const nlohmann::ordered_json& machine, int repeat);

}  // namespace lrsm
