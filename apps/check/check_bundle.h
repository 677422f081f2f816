#pragma once

#include "apps/check/check.h"
#include "core/base/output_folder.h"

/// What `lrsm check` found, as a folder to look into.
namespace lrsm {

/// report.html, check.json, and for each wrong buffer NAME.expected, .actual and .difference as .npy and .png. `inputs` is what the passes read.
void writeCheck(OutputFolder& folder, const CheckReport& report, const Capture& inputs, const std::string& title);

}  // namespace lrsm
