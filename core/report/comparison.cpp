#include "core/report/comparison.h"

#include <string_view>

namespace lrsm {
namespace {

constexpr std::string_view kComparisonStyle = R"(
.pair { position: relative; width: 100%; max-width: 1280px; line-height: 0; }
.pair img { display: block; width: 100%; image-rendering: pixelated; }
.pair .over { position: absolute; left: 0; top: 0; height: 100%; overflow: hidden; width: 50%; border-right: 1px solid #fff; }
.pair .over img { width: auto; height: 100%; }
.controls { margin: .4em 0 1em; } .controls input[type=range] { width: min(40em, 60%); vertical-align: middle; }
.maps { display: flex; flex-wrap: wrap; gap: 1em; } .maps img { max-width: 100%; width: 620px; image-rendering: pixelated; }
)";

// The left part shows the test. "Flicker" swaps the two in place, which is what the eye compares best.
constexpr std::string_view kComparisonScript = R"(
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

std::string sectionHtml(const ComparedLayer& section)
{
    std::string html = headingHtml(section.title) + "<div class=\"compare\"><div class=\"pair\">" + pictureHtml(section.reference) + "<div class=\"over\">" +
                       pictureHtml(section.test) + "</div></div>\n" +
                       "<div class=\"controls\"><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"slider\"> "
                       "<label><input type=\"checkbox\"> flicker</label> <output></output></div></div>\n";
    for (const ReportTable& table : section.tables) html += tableHtml(table);
    html += "<div class=\"maps\">\n";
    for (const ReportPicture& map : section.maps) html += "<figure>" + pictureHtml(map) + "<figcaption>" + htmlEscaped(map.title) + "</figcaption></figure>\n";
    return html + "</div>\n";
}

}  // namespace

std::string comparisonPage(const Comparison& comparison)
{
    std::string body;
    for (const ComparedLayer& layer : comparison.layers) body += sectionHtml(layer);
    if (!comparison.settings.empty()) body += headingHtml("Settings");
    for (const auto& [heading, text] : comparison.settings) body += foldedHtml(heading, preformattedHtml(text), true);
    return htmlPage({.title = comparison.title,
                     .summary = comparison.summary,
                     .bodyHtml = body,
                     .style = std::string(kComparisonStyle),
                     .script = std::string(kComparisonScript)});
}

}  // namespace lrsm
