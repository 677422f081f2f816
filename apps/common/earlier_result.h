#pragma once

#include "core/base/output_folder.h"

#include <string>

/// What an output folder holds of an earlier run.
namespace lrsm {

/// InputError where the folder holds what another command wrote, which `command` ("render", "reference", "capture") would write over or mix with.
void refuseOtherResult(const std::string& folder, const std::string& command);

/// For OutputFolder::commit: files that `command` writes only at times, where it was that which wrote the folder.
OutputFolder::Earlier leftBy(const std::string& command, std::vector<std::string> files);

}  // namespace lrsm
