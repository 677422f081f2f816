#pragma once

#include "apps/capture/capture.h"

#include <nlohmann/json_fwd.hpp>

namespace lrsm {

/// The capture that a manifest describes; its buffers have no bytes. InputError "PLACE: key: why" for what is missing or makes no sense; what the
/// program derives itself is not read.
Capture captureFromManifest(const nlohmann::ordered_json& manifest, const std::string& place);

}  // namespace lrsm
