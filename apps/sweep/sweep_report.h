#pragma once

#include "apps/sweep/measurement.h"

#include <string>
#include <vector>

/// The page that shows a sweep: error against time and memory, what each setting buys, and the path tracer beside it.
namespace lrsm {

/// DIR/report.html. `directory` holds thumbnails/<key>.png; those that are there are carried by the page, which needs no network. Rows may be
/// those of a sweep in progress: presets, scenes and path tracer may be missing.
std::string sweepReportHtml(const std::vector<Measurement>& rows, const std::string& directory);

/// DIR/tables.md: scenes, presets, all scenes, one setting at a time, each a heading and a table, for pages of documentation.
std::string sweepTablesMarkdown(const std::vector<Measurement>& rows);

}  // namespace lrsm
