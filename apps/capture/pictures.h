#pragma once

#include "apps/capture/capture.h"

namespace lrsm {

class OutputFolder;

/// What a capture holds, to look at: frame.exr and rsm<i>.exr (float32, a layer a buffer, under the buffer's name) and contact-sheet.png. Of
/// buffers that are left out nothing is written. Deterministic; `check` does not read them.
void writePictures(OutputFolder& folder, const Capture& capture);

/// The names of all that it may write beside buffers in `files`.
std::vector<std::string> pictureFiles(const std::vector<std::string>& files);

}  // namespace lrsm
