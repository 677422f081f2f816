#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// One self-contained HTML file: pictures inside as base64, no script or style from elsewhere.
namespace lrsm {

struct ReportTable {
    std::string title;
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};

struct ReportPicture {
    std::string title;
    std::vector<std::byte> png;
};

/// One layer's section: the two pictures to slide and flicker between, maps to look at, numbers.
struct ReportSection {
    std::string title;
    ReportPicture reference, test;
    std::vector<ReportPicture> maps;
    std::vector<ReportTable> tables;
};

struct Report {
    std::string title;
    std::string summary;  ///< a sentence or two, plain text
    std::vector<ReportSection> sections;
    std::vector<std::pair<std::string, std::string>> settings;  ///< heading and preformatted text, of either side
};

/// All text is escaped. The page works without a network and, but for the slider, without scripts.
std::string htmlReport(const Report& report);

}  // namespace lrsm
