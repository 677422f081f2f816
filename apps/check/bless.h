#pragma once

#include "apps/capture/capture.h"

/// A change of a golden that somebody stands up for.
namespace lrsm {

/// The candidate's buffers with the golden's history and one more entry: who reads the manifest learns why, with which version, and which buffers.
/// The golden's choice of DDS files stays. Without any byte that differs the history is the golden's: there is nothing to write.
/// InputError that says what differs when the candidate is of another scene, size, settings, or has other buffers; or when `reason` is blank.
Capture blessed(const Capture& golden, const Capture& candidate, const std::string& reason, const std::string& version);

}  // namespace lrsm
