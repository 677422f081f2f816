#pragma once

#include "apps/sweep/front.h"
#include "apps/sweep/measurement.h"

#include <string>
#include <vector>

/// Rows sorted by what they may be compared with.
namespace lrsm {

/// The rows of one case (scene, camera, size, truth). Points into the rows that it was made from.
struct CaseRows {
    std::string name, caseKey;                   ///< name: the scene's; with size and key where two cases share it
    std::vector<const Measurement*> settings;    ///< LRSM, in the order of the rows
    std::vector<const Measurement*> pathTracer;  ///< by rising samples
};
/// Cases in order of their first row.
std::vector<CaseRows> casesOf(const std::vector<Measurement>& rows);

/// The row with these very settings; nullptr when there is none.
const Measurement* findSettings(const CaseRows& rows, const Settings& settings);

/// Rows of the Pareto front of PictureError::net against cost, and against bytes; by rising cost or bytes.
std::vector<const Measurement*> timeFront(const CaseRows& rows);
std::vector<const Measurement*> memoryFront(const CaseRows& rows);

/// Cost and net error of a row over those of `baseline`, a row of the same case (the preset `balanced`), so that scenes of any brightness and cost can be
/// averaged. Errors below 1e-6 count as 1e-6, so that exact pictures have ratios.
CostError relativeTo(const Measurement& row, const Measurement& baseline);

/// Cost and net error of the path tracer's rows, by rising cost.
std::vector<CostError> pathTracerCurve(const CaseRows& rows);

/// One setting (or number of paths) over all cases: geometric means of its figures over those of `balanced` in the same case.
struct CombinedRow {
    std::vector<const Measurement*> rows;  ///< one a case, in the cases' order
    std::vector<CostError> relative;       ///< of each, over its case's `balanced`
    double error = 1.0, cost = 1.0, bytes = 1.0;
};
struct CombinedCases {
    std::vector<const CaseRows*> cases;   ///< those with `balanced`, without which nothing is relative
    std::vector<CombinedRow> settings;    ///< measured in each of them, in the order of the first case
    std::vector<CombinedRow> pathTracer;  ///< by rising samples; `bytes` means nothing
    double noise = 0.0;                   ///< of the truths, in the same unit as `error`
};
/// Points into `cases`.
CombinedCases combineCases(const std::vector<CaseRows>& cases);
/// Settings of the Pareto front of error against cost, by rising cost.
std::vector<const CombinedRow*> combinedFront(const CombinedCases& all);

}  // namespace lrsm
