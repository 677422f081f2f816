#pragma once

#include "core/imageio/display.h"
#include "core/report/html.h"
#include "reference/sequence_metrics.h"

#include <string>
#include <vector>

/// The page that shows two sequences, frame by frame under a slider.
namespace lrsm {

/// A frame of the page: pictures small enough to carry many of.
struct ShownFrame {
    int frame = 0;
    double time = 0.0;
    std::vector<std::byte> test, reference, error;  ///< PNG
};

struct SequenceSection {
    std::string layer;
    SequenceMetrics metrics;
    std::vector<int> frames;  ///< their numbers, one for each of metrics.moments
    std::vector<ShownFrame> shown;
    std::vector<ReportPicture> maps;
};

struct SequenceReport {
    std::string title, summary;
    std::vector<SequenceSection> layers;
};

/// The table of a section's numbers, for page and terminal.
ReportTable sequenceTable(const SequenceSection& section);

/// Self-contained: it loads nothing.
std::string sequencePage(const SequenceReport& report);

/// The mean of blocks, so that the picture is `width` wide at the most; whole blocks alone.
Image<Vec3> shrunk(const Image<Vec3>& picture, int width);

}  // namespace lrsm
