#pragma once

#include "reference/checkpoint.h"
#include "reference/path_trace.h"

#include <atomic>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

/// One reference from its first sample to its files, interruptible: what `lrsm reference` does, and what measures against a truth does too.
namespace lrsm {

/// What samples belong to: program version, scene, camera, size, model, seed, block, aperture of the cone layer, what the pilot has found.
Identity identifyReference(const PathTracer& tracer, const Camera& camera, const std::string& sceneHash);

struct TraceOptions {
    std::string folder;  ///< of samples.bin; empty: no checkpoints
    double checkpointSeconds = 60.0;
    std::function<void(const std::string& text, double fraction)> show = {};  ///< told the time left, five times a second
    const std::atomic<bool>* stop = nullptr;
};

/// Renders what is left of the state's own range, then what `range` adds at its end. False when stopped: the folder then holds what is done, in `checkpoint`'s
/// identity and unit.
bool traceRange(const PathTracer& tracer, ReferenceState& state, const SampleRange& range, Checkpoint& checkpoint, const TraceOptions& options);

/// RMSE / mean of the irradiance as its stored variance tells it, over what the eye sees; infinite before two blocks are complete.
double noiseOf(const PathTracer& tracer, const SampleSums& sums);

/// Renders what is left of the state's own range, then whole blocks until that noise is at most `target`: how many samples that takes depends on the picture
/// alone, not on time, threads or interruptions. False when stopped.
bool traceToNoise(const PathTracer& tracer, ReferenceState& state, double target, Checkpoint& checkpoint, const TraceOptions& options);

/// All but the size.
nlohmann::ordered_json referenceSettingsJson(const ReferenceSettings& settings);

/// frame.json of a finished reference.
nlohmann::ordered_json referenceJson(const Scene& scene, const std::string& sceneHash, const Camera& camera, const PathTracer& tracer,
                                     const ReferenceState& state);

}  // namespace lrsm
