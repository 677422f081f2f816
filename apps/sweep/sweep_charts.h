#pragma once

#include "apps/sweep/cases.h"
#include "core/report/chart.h"

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

/// The plots of a sweep, and the thumbnails under their points.
namespace lrsm {

/// The thumbnails that the page carries, each once.
struct SweepPictures {
    std::vector<std::vector<std::byte>> pngs;
    std::unordered_map<std::string, int> byKey;  ///< a row's key to its place; looked up, never walked
    std::size_t found = 0;                       ///< files there were
    /// A list of none or one: of a row's key, or of a case's, whose picture is the truth.
    std::vector<int> of(const std::string& key) const;
};
/// Those of DIR/thumbnails, as many as `budget` bytes hold: first the truths', then those of presets, fronts and path tracer.
SweepPictures loadThumbnails(const std::vector<CaseRows>& cases, const CombinedCases& all, const std::string& directory, std::size_t budget);

/// Error against time and memory.
std::string caseCharts(const CaseRows& rows, const SweepPictures& pictures, const std::string& timeUnit);
/// FLIP and energy against time.
std::string otherMetricCharts(const CaseRows& rows, const SweepPictures& pictures, const std::string& timeUnit);
/// Error against time and memory over all cases, relative to `balanced`.
std::string combinedCharts(const CombinedCases& all, const SweepPictures& pictures);

}  // namespace lrsm
