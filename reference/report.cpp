#include "reference/report.h"

#include <string_view>

namespace lrsm {
namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; }
body { font: 15px/1.45 system-ui, sans-serif; max-width: 1300px; margin: 1.5em auto; padding: 0 1em; }
table { border-collapse: collapse; margin: .6em 0 1.2em; } caption { text-align: left; font-weight: 600; padding: .3em 0; }
td, th { padding: .15em .7em; border-bottom: 1px solid #8885; text-align: right; font-variant-numeric: tabular-nums; }
td:first-child, th:first-child { text-align: left; }
.pair { position: relative; display: inline-block; max-width: 100%; line-height: 0; }
.pair img { display: block; max-width: 100%; image-rendering: pixelated; }
.pair .over { position: absolute; left: 0; top: 0; height: 100%; overflow: hidden; width: 50%; border-right: 1px solid #fff; }
.pair .over img { max-width: none; height: 100%; }
.controls { margin: .4em 0 1em; } .controls input[type=range] { width: min(40em, 60%); vertical-align: middle; }
.maps { display: flex; flex-wrap: wrap; gap: 1em; } figure { margin: 0; } .maps img { max-width: 100%; width: 620px; image-rendering: pixelated; }
pre { overflow-x: auto; background: #8881; padding: .6em; }
)";

// The left part shows the test. "Flicker" swaps the two in place, which is what the eye compares best.
constexpr std::string_view kScript = R"(
for (const box of document.querySelectorAll('.compare')) {
  const pair = box.querySelector('.pair'), over = box.querySelector('.over'), inner = over.querySelector('img');
  const slide = box.querySelector('input[type=range]'), flick = box.querySelector('input[type=checkbox]'), now = box.querySelector('output');
  let timer = 0, shown = false;
  const fit = () => { inner.style.width = pair.clientWidth + 'px'; };
  const draw = () => {
    over.style.width = flick.checked ? (shown ? '100%' : '0') : slide.value + '%';
    now.textContent = flick.checked ? (shown ? 'test' : 'reference') : 'left: test, right: reference';
  };
  slide.addEventListener('input', () => { flick.checked = false; clearInterval(timer); draw(); });
  flick.addEventListener('change', () => {
    clearInterval(timer);
    if (flick.checked) timer = setInterval(() => { shown = !shown; draw(); }, 500);
    draw();
  });
  pair.addEventListener('mousemove', e => { if (!flick.checked) { slide.value = 100 * e.offsetX / pair.clientWidth; draw(); } });
  addEventListener('resize', fit); addEventListener('load', () => { fit(); draw(); });
}
)";

std::string escaped(std::string_view text)
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

std::string image(const ReportPicture& picture)
{
    return "<img alt=\"" + escaped(picture.title) + "\" src=\"data:image/png;base64," + base64(picture.png) + "\">";
}

std::string tableHtml(const ReportTable& table)
{
    std::string html = "<table><caption>" + escaped(table.title) + "</caption><tr>";
    for (const std::string& cell : table.head) html += "<th>" + escaped(cell) + "</th>";
    html += "</tr>\n";
    for (const auto& row : table.rows) {
        html += "<tr>";
        for (const std::string& cell : row) html += "<td>" + escaped(cell) + "</td>";
        html += "</tr>\n";
    }
    return html + "</table>\n";
}

std::string sectionHtml(const ReportSection& section)
{
    std::string html = "<h2>" + escaped(section.title) + "</h2>\n<div class=\"compare\"><div class=\"pair\">" + image(section.reference) +
                       "<div class=\"over\">" + image(section.test) + "</div></div>\n" +
                       "<div class=\"controls\"><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"slider\"> "
                       "<label><input type=\"checkbox\"> flicker</label> <output></output></div></div>\n";
    for (const ReportTable& table : section.tables) html += tableHtml(table);
    html += "<div class=\"maps\">\n";
    for (const ReportPicture& map : section.maps) html += "<figure>" + image(map) + "<figcaption>" + escaped(map.title) + "</figcaption></figure>\n";
    return html + "</div>\n";
}

}  // namespace

std::string htmlReport(const Report& report)
{
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
                       escaped(report.title) + "</title>\n<style>" + std::string(kStyle) + "</style></head>\n<body><h1>" + escaped(report.title) +
                       "</h1>\n<p>" + escaped(report.summary) + "</p>\n";
    for (const ReportSection& section : report.sections) html += sectionHtml(section);
    if (!report.settings.empty()) html += "<h2>Settings</h2>\n";
    for (const auto& [heading, text] : report.settings)
        html += "<details open><summary>" + escaped(heading) + "</summary><pre>" + escaped(text) + "</pre></details>\n";
    return html + "<script>" + std::string(kScript) + "</script></body></html>\n";
}

}  // namespace lrsm
