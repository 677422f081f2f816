#include "core/report/html.h"

namespace lrsm {
namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; }
body { font: 15px/1.45 system-ui, sans-serif; max-width: 1300px; margin: 1.5em auto; padding: 0 1em; }
table { border-collapse: collapse; margin: .6em 0 1.2em; } caption { text-align: left; font-weight: 600; padding: .3em 0; }
td, th { padding: .15em .7em; border-bottom: 1px solid #8885; text-align: left; vertical-align: top; }
.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
tr.failed td { background: #e5484d33; }
details { margin: .4em 0; } summary { cursor: pointer; font-weight: 600; }
figure { margin: 0; } .wide { overflow-x: auto; }
pre { overflow-x: auto; background: #8881; padding: .6em; }
)";

std::string base64(const std::vector<std::byte>& bytes)
{
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    result.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? unsigned(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) result += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63u];
    }
    return result;
}

std::string element(std::string_view tag, std::string_view text)
{
    return "<" + std::string(tag) + ">" + htmlEscaped(text) + "</" + std::string(tag) + ">";
}

}  // namespace

std::string htmlEscaped(std::string_view text)
{
    std::string result;
    for (const char letter : text) switch (letter) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        default: result += letter;
        }
    return result;
}

std::string pngUri(const std::vector<std::byte>& png)
{
    return "data:image/png;base64," + base64(png);
}

std::string pictureHtml(const ReportPicture& picture)
{
    return "<img alt=\"" + htmlEscaped(picture.title) + "\" src=\"" + pngUri(picture.png) + "\">";
}

std::string tableHtml(const ReportTable& table)
{
    const std::vector<bool> numbers = numberColumns(table);
    const auto cell = [&](std::string_view tag, std::size_t column, std::string_view text) {
        const bool number = column < numbers.size() && numbers[column];
        return "<" + std::string(tag) + (number ? " class=\"number\">" : ">") + htmlEscaped(text) + "</" + std::string(tag) + ">";
    };
    std::string html = "<div class=\"wide\"><table><caption>" + htmlEscaped(table.title) + "</caption><tr>";
    for (std::size_t i = 0; i < table.head.size(); ++i) html += cell("th", i, table.head[i]);
    html += "</tr>\n";
    for (const auto& row : table.rows) {
        const bool failed = !row.empty() && row.front().starts_with('!');
        html += failed ? "<tr class=\"failed\">" : "<tr>";
        for (std::size_t i = 0; i < row.size(); ++i) html += cell("td", i, std::string_view(row[i]).substr(failed && i == 0 ? 1 : 0));
        html += "</tr>\n";
    }
    return html + "</table></div>\n";
}

std::string headingHtml(std::string_view text)
{
    return element("h2", text) + "\n";
}

std::string paragraphHtml(std::string_view text)
{
    return element("p", text) + "\n";
}

std::string foldedHtml(std::string_view summary, std::string_view bodyHtml, bool open)
{
    return std::string(open ? "<details open>" : "<details>") + element("summary", summary) + std::string(bodyHtml) + "</details>\n";
}

std::string preformattedHtml(std::string_view text)
{
    return element("pre", text);
}

std::string htmlPage(const HtmlPage& page)
{
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\n" +
                       element("title", page.title) + "\n<style>" + std::string(kStyle) + page.style + "</style></head>\n<body>" + element("h1", page.title) +
                       "\n" + paragraphHtml(page.summary) + page.bodyHtml;
    if (!page.script.empty()) html += "<script>" + page.script + "</script>";
    return html + "</body></html>\n";
}

}  // namespace lrsm
