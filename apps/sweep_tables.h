#pragma once

#include "core/report/table.h"
#include "sweep/effects.h"
#include "sweep/rivals.h"

#include <string>
#include <vector>

/// The numbers of a sweep as tables for people.
namespace lrsm {

/// "+3.2 %" and the like are written with three significant digits.
std::string percentText(double ratio);

/// What a row changes against `balanced`: "cone_count=4, filter=false"; "nothing" for itself; "16 paths a pixel" for the path tracer.
std::string changedText(const Measurement& row);

ReportTable casesTable(const std::vector<CaseRows>& cases);
/// Effects but those that change nothing; those alone.
ReportTable effectsTable(const std::vector<Effect>& effects);
ReportTable nothingTable(const std::vector<Effect>& effects);
/// Values on no front; the others of the same settings are named beside them. `unchanged`: labels ("key=value") that change no bit.
ReportTable neverTable(const std::vector<TriedValue>& tried, const std::vector<Effect>& effects);
ReportTable equalSummaryTable(const std::vector<EqualSummary>& presets);
ReportTable equalTable(const std::vector<EqualRow>& rows);
ReportTable tracerTable(const std::vector<TracerRow>& rows);
ReportTable frontTable(const std::string& title, const std::vector<const Measurement*>& front);
ReportTable combinedFrontTable(const CombinedCases& all);

}  // namespace lrsm
