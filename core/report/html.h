#pragma once

#include "core/report/table.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Parts of a self-contained HTML page: pictures inside as base64, no script or style from elsewhere. All text given is escaped.
namespace lrsm {

struct ReportPicture {
    std::string title;
    std::vector<std::byte> png;
};

std::string htmlEscaped(std::string_view text);

/// "data:image/png;base64,...".
std::string pngUri(const std::vector<std::byte>& png);

/// An <img> that carries its picture.
std::string pictureHtml(const ReportPicture& picture);

/// Columns of numbers stand to the right; the mark of a failed row becomes its colour.
std::string tableHtml(const ReportTable& table);

std::string headingHtml(std::string_view text);
std::string paragraphHtml(std::string_view text);

/// A section that opens on a click.
std::string foldedHtml(std::string_view summary, std::string_view bodyHtml, bool open = false);

/// Preformatted text.
std::string preformattedHtml(std::string_view text);

struct HtmlPage {
    std::string title;
    std::string summary;      ///< a sentence or two, plain text
    std::string bodyHtml;     ///< parts made by the functions above, in order
    std::string style = {};   ///< CSS besides the common one
    std::string script = {};  ///< JavaScript at the page's end
};

/// The page works without a network.
std::string htmlPage(const HtmlPage& page);

}  // namespace lrsm
