#pragma once

#include "apps/capture/capture.h"

#include <nlohmann/json_fwd.hpp>

namespace lrsm {

/// All that docs/capture.md says of manifest.json, what follows from the capture included. Floats are written as doubles that read back to
/// the same bits.
nlohmann::ordered_json manifestJson(const Capture& capture);

}  // namespace lrsm
