#pragma once

#include "apps/check/check.h"
#include "core/base/output_folder.h"

#include <nlohmann/json_fwd.hpp>
#include <string>

/// What `lrsm check` found, for a terminal, for programs, for CI servers, and as a folder to look into.
namespace lrsm {

/// One line a buffer; runs of mips that are all right share one.
std::string checkTable(const CheckReport& report);

nlohmann::ordered_json checkJson(const CheckReport& report);

/// A suite a pass, a case a buffer: the format that Jenkins, GitLab and others read.
std::string checkJUnit(const CheckReport& report, const std::string& name);

/// report.html, check.json, and for each wrong buffer NAME.expected, .actual and .difference as .npy and .png. `inputs` is what the passes read.
void writeCheck(OutputFolder& folder, const CheckReport& report, const Capture& inputs, const std::string& title);

}  // namespace lrsm
