#pragma once

#include "apps/capture/capture.h"

#include <nlohmann/json_fwd.hpp>

namespace lrsm {

/// All that docs/capture.md says of manifest.json, what follows from the capture included. Floats are written as doubles that read back to
/// the same bits.
nlohmann::ordered_json manifestJson(const Capture& capture);

/// The capture that a manifest describes; its buffers have no bytes. InputError "PLACE: key: why" for what is missing or makes no sense; what the
/// program derives itself is not read.
Capture captureFromManifest(const nlohmann::ordered_json& manifest, const std::string& place);

}  // namespace lrsm
