#include "apps/compare/sequence_page.h"

#include "core/report/chart.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kSequenceStyle = R"(
.scrub figure { display: inline-block; margin: 0 .6em .6em 0; width: 31%; vertical-align: top; } .scrub img { width: 100%; image-rendering: pixelated; display: block; }
.scrub input[type=range] { width: min(48em, 70%); vertical-align: middle; } .scrub output { margin-left: 1em; font-variant-numeric: tabular-nums; }
.maps { display: flex; flex-wrap: wrap; gap: 1em; } .maps img { max-width: 100%; width: 400px; image-rendering: pixelated; }
)";

// A section's pictures lie in a list beside it; the slider picks, "play" runs through.
constexpr std::string_view kSequenceScript = R"(
for (const box of document.querySelectorAll('.scrub')) {
  const shown = JSON.parse(box.querySelector('script').textContent), images = box.querySelectorAll('img');
  const slide = box.querySelector('input[type=range]'), play = box.querySelector('input[type=checkbox]'), now = box.querySelector('output');
  let timer = 0;
  const draw = () => { const s = shown[slide.value]; s.pictures.forEach((p, i) => { images[i].src = p; }); now.textContent = s.text; };
  slide.addEventListener('input', draw);
  play.addEventListener('change', () => {
    clearInterval(timer);
    if (play.checked) timer = setInterval(() => { slide.value = (Number(slide.value) + 1) % shown.length; draw(); }, Number(box.dataset.milliseconds));
  });
  draw();
}
)";

std::string figureOf(double value)
{
    return numberText(4, value);
}

std::string shareText(double share)
{
    return numberText(3, 100.0 * share) + " %";
}

std::size_t placeOf(const SequenceSection& section, int frame)
{
    return std::size_t(frame - section.frames.front());
}

std::string scrubberHtml(const SequenceSection& section)
{
    Json shown = Json::array();
    for (const ShownFrame& frame : section.shown) {
        const MomentMetrics& m = section.metrics.moments[placeOf(section, frame.frame)];
        const auto known = [](const char* name, double value) { return std::isfinite(value) ? ", " + (name + figureOf(value)) : std::string(); };
        shown.push_back({{"text", "frame " + std::to_string(frame.frame) + " at " + figureOf(frame.time) + " s: RMSE / mean " + figureOf(m.rmse) +
                                      known("F_e ", m.flickerOfError) + known("jump ", m.jump)},
                         {"pictures", {pngUri(frame.reference), pngUri(frame.test), pngUri(frame.error)}}});
    }
    const double seconds = section.shown.size() > 1 ? section.shown[1].time - section.shown[0].time : 0.0;
    const auto figure = [](const std::string& title) { return "<figure><img alt=\"" + title + "\"><figcaption>" + title + "</figcaption></figure>"; };
    return "<div class=\"scrub\" data-milliseconds=\"" + std::to_string(int(seconds > 0.0 ? 1000.0 * seconds + 0.5 : 100.0)) + "\">" + figure("reference") +
           figure("test") + figure("signed error: red too bright, blue too dark, full at one mean of the reference") +
           "<div><input type=\"range\" min=\"0\" max=\"" + std::to_string(section.shown.size() - 1) +
           "\" value=\"0\" aria-label=\"frame\"> <label><input type=\"checkbox\"> play</label><output></output></div>" + "<script type=\"application/json\">" +
           shown.dump() + "</script></div>\n";
}

Chart curve(const SequenceSection& section, const std::string& title, const std::string& label,
            const std::vector<std::pair<std::string, double MomentMetrics::*>>& values)
{
    Chart chart{title, "frame", label};
    for (const auto& [name, value] : values) {
        ChartSeries series{name};
        for (std::size_t t = 0; t < section.frames.size(); ++t) {
            series.x.push_back(section.frames[t]);
            series.y.push_back(section.metrics.moments[t].*value);
        }
        chart.series.push_back(std::move(series));
    }
    return chart;
}

std::string sectionHtml(const SequenceSection& section)
{
    std::string html = headingHtml("Layer " + section.layer) + tableHtml(sequenceTable(section)) + scrubberHtml(section);
    html += chartHtml(curve(section, "What flickers: mean |D2| over the mean of the reference", "",
                            {{"F_e, the error's", &MomentMetrics::flickerOfError},
                             {"F of the test", &MomentMetrics::flicker},
                             {"F of the reference", &MomentMetrics::flickerReference}}));
    html += chartHtml(curve(section, "Jumps of the error from the frame before: 99.9th percentile over the mean", "", {{"jump", &MomentMetrics::jump}}));
    html += chartHtml(curve(section, "Error of each frame", "RMSE / mean", {{"RMSE", &MomentMetrics::rmse}}));
    html += chartHtml(curve(section, "Mean luminance", "", {{"test", &MomentMetrics::meanTest}, {"reference", &MomentMetrics::meanReference}}));
    html += "<div class=\"maps\">\n";
    for (const ReportPicture& map : section.maps) html += "<figure>" + pictureHtml(map) + "<figcaption>" + htmlEscaped(map.title) + "</figcaption></figure>\n";
    return html + "</div>\n";
}

}  // namespace

ReportTable sequenceTable(const SequenceSection& section)
{
    const SequenceMetrics& m = section.metrics;
    const auto frame = [&](std::size_t t) { return "frame " + std::to_string(section.frames[t]); };
    ReportTable table{"Layer " + section.layer + ", " + std::to_string(section.frames.size()) + " frames", {"metric", "value", "what it is"}, {}};
    table.rows = {{"F", figureOf(m.flicker), "flicker of the test: mean |D2 x| over the mean"},
                  {"F of the reference", figureOf(m.flickerReference), "light that really changes its pace, and the reference's noise"},
                  {"F_e", figureOf(m.flickerOfError), "flicker that is error; worst: " + frame(m.worstFlicker)},
                  {"V", m.dance ? figureOf(*m.dance) : "-",
                   m.dance ? "variance in time where the reference stands still: " + shareText(m.stillShare) + " of the pixels"
                           : "the camera moves, or no pixel of the reference stands still"},
                  {"J", figureOf(m.jump), "largest jump of the error, 99.9th percentile; into " + frame(m.worstJump)}};
    if (m.followedShare < 1.0) table.rows.push_back({"followed", shareText(m.followedShare), "of the pixels were found again in the frame before"});
    return table;
}

std::string sequencePage(const SequenceReport& report)
{
    std::string body;
    for (const SequenceSection& section : report.layers) body += sectionHtml(section);
    return htmlPage({.title = report.title,
                     .summary = report.summary,
                     .bodyHtml = body,
                     .style = std::string(kSequenceStyle) + chartStyle(),
                     .script = std::string(kSequenceScript) + chartScript()});
}

Image<Vec3> shrunk(const Image<Vec3>& picture, int width)
{
    const int block = (picture.width + width - 1) / width;
    if (block <= 1 || picture.height < block) return picture;
    Image<Vec3> small(picture.width / block, picture.height / block);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            Vec3 sum(0.0f);
            for (int j = 0; j < block; ++j)
                for (int i = 0; i < block; ++i) sum += picture.at(x * block + i, y * block + j);
            small.at(x, y) = sum / float(block * block);
        }
    return small;
}

}  // namespace lrsm
