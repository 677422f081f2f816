#pragma once

#include "apps/capture/capture.h"

#include <optional>

/// A pass of ours run anew on what is in a capture, so that a pass can be judged by its own inputs.
namespace lrsm {

struct Rerun {
    std::vector<Buffer> outputs;  ///< those buffers of the pass that `inputs` has, with the bytes that our pass makes
    std::string why;              ///< of what could not be made: "rsm0.depth is not in the capture"; empty: all was
};

/// What `pass` ("voxel mips", "lrsm 0", "direct", "cones", "filter", "composite", ...) makes of the buffers in `inputs`.
///
/// Mip chains level by level: each from the level below as it is in `inputs`, so that a wrong level does not make those above it wrong. LRSMs
/// with the capture's layer ranges, not ranges fitted to the RSM in it.
/// "voxelize", "rsm i" and "gbuffer" read the scene, which must be whole (Capture::sceneComplete).
Rerun rerunPass(const Capture& inputs, const std::string& pass);

/// One output of "rsm i" or of the base level of "lrsm i" as float32, before it is converted to its storage. Nothing where that cannot be had.
std::optional<Buffer> wideOutput(const Capture& inputs, const std::string& buffer);

/// Does the pass read the scene and tables alone? Then the golden is what ours makes of the candidate's inputs.
bool readsSceneAlone(const CapturedPass& pass);

/// "lrsm 1" -> 1; 0 without a number.
std::size_t lightOfPass(const std::string& pass);

/// "lrsm0.depth.mip3" -> 3; 0 for others. The order of the data flow within a pass.
int levelOf(const std::string& buffer);

}  // namespace lrsm
