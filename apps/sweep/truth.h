#pragma once

#include "apps/common/progress.h"
#include "apps/sweep/measure.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

/// The truth that settings are held against: path traced once for a scene, view and size, and found again by what it is of.
namespace lrsm {

/// Single bounce, seed 0, at least `samples` paths a pixel. Any folder in `references` whose samples.bin is of this scene, view, size and program version and
/// has enough samples serves, whoever made it and whatever it is called. Otherwise the folder named after the hash of its identity is made, or what is there is
/// continued; it then holds what `lrsm reference` writes. `references` empty: nothing is read or kept. Nothing when `stop` was set meanwhile; what is done is
/// kept there. InputError for fewer samples than the noise can be told from.
std::optional<Truth> findOrMakeTruth(const SceneCase& sceneCase, std::uint64_t samples, const std::string& references, Progress& progress,
                                     const std::atomic<bool>* stop = nullptr);

}  // namespace lrsm
