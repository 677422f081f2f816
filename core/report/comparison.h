#pragma once

#include "core/report/html.h"

#include <string>
#include <utility>
#include <vector>

/// The page that sets a picture beside its reference.
namespace lrsm {

/// One layer's section: the two pictures to slide and flicker between, maps to look at, numbers.
struct ComparedLayer {
    std::string title;
    ReportPicture reference, test;
    std::vector<ReportPicture> maps;
    std::vector<ReportTable> tables;
};

struct Comparison {
    std::string title;
    std::string summary;  ///< a sentence or two, plain text
    std::vector<ComparedLayer> layers;
    std::vector<std::pair<std::string, std::string>> settings;  ///< heading and preformatted text, of either side
};

/// But for the slider, the page works without scripts.
std::string comparisonPage(const Comparison& comparison);

}  // namespace lrsm
