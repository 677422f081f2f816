#pragma once

#include "apps/capture/capture.h"
#include "conetrace/render.h"

#include <functional>

namespace lrsm {

struct RecordOptions {
    int width = 1280, height = 720;
    std::vector<std::string> only;  ///< passes whose buffers are kept; empty: all. "rsm" and "lrsm" mean every light's. Scene and tables stay.
    bool dds = true;                ///< the texture-shaped buffers are to be DDS files too
    std::function<void(const std::string& pass, double fraction)> progress;  ///< may be empty
    std::function<void(const Frame&)> finished;                              ///< shown the frame before the capture is made of it; may be empty
};

/// The buffers that recordCapture will keep, without bytes, for predictCaptureBytes. `layersStored` has one entry a light. InputError for an
/// unknown pass in `only`.
std::vector<Buffer> chosenBuffers(const Scene& scene, const Requirements& needs, const Settings& settings, const RecordOptions& options,
                                  const std::vector<int>& layersStored);

/// Renders the frame (renderFrame, with an observer) and keeps every pass's output.
Capture recordCapture(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, const RecordOptions& options,
                      const std::string& version);

}  // namespace lrsm
