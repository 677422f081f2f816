#pragma once

#include <string>

namespace lrsm {

/// Frames begin .. end - 1 of a folder, each with an image.png, as a film.
struct PreviewRange {
    int begin = 0, end = 0;
    double fps = 24.0;
};

/// Writes `folder`/preview.mp4 with ffmpeg, or preview.webp with img2webp, whichever the PATH has first; an earlier one is replaced when the new one is whole.
/// Returns the file's name; empty where neither is there or can do it.
std::string makePreview(const std::string& folder, const PreviewRange& range);

/// The commands that would.
std::string previewHint(const std::string& folder, const PreviewRange& range);

}  // namespace lrsm
