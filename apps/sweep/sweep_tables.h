#pragma once

#include "apps/sweep/effects.h"
#include "apps/sweep/rivals.h"
#include "core/report/table.h"

#include <string>
#include <vector>

/// The numbers of a sweep as tables for people.
namespace lrsm {

/// "+3.2 %" and the like are written with three significant digits.
std::string percentText(double ratio);
/// Three digits, and all of those before the point: for frames, milliseconds and megabytes.
std::string plainNumber(double value);

/// What a row changes against `balanced`: "cone_count=4, filter=false"; "nothing" for itself; "16 paths a pixel" for the path tracer.
std::string changedText(const Measurement& row);

ReportTable casesTable(const std::vector<CaseRows>& cases);
/// Effects but those that change nothing; those alone.
ReportTable effectsTable(const std::vector<Effect>& effects);
ReportTable nothingTable(const std::vector<Effect>& effects);
ReportTable equalSummaryTable(const std::vector<EqualSummary>& presets);
/// Presets scene by scene, the path tracer beside them.
ReportTable presetsTable(const std::vector<EqualRow>& rows);
ReportTable frontTable(const std::string& title, const std::vector<const Measurement*>& front);
/// Settings measured on all scenes by rising cost, over balanced: mean (least .. largest), and the error scene by scene.
ReportTable combinedTable(const CombinedCases& all);

}  // namespace lrsm
