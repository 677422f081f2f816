#include "synthetic_sweep.h"

#include "apps/sweep/sweep_report.h"
#include "core/imageio/image_io.h"

#include <catch.h>
#include <python.h>
#include <scratch.h>
#include <algorithm>
#include <cstdlib>

using namespace lrsm;
using namespace lrsm::test;

namespace {

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
    return found;
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// A picture that no other row has.
void writeThumbnails(const ScratchFolder& folder, const std::vector<Measurement>& rows)
{
    Image<Rgb8> picture(160, 90);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (int y = 0; y < 90; ++y)
            for (int x = 0; x < 160; ++x) picture.at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(2 * y), static_cast<std::uint8_t>(i)};
        const std::vector<std::byte> png = encodePng(picture);
        const std::string_view bytes(reinterpret_cast<const char*>(png.data()), png.size());
        folder.write("thumbnails/" + rows[i].key + ".png", bytes);
        folder.write("thumbnails/" + rows[i].caseKey + ".png", bytes);  // the truth's
    }
}

std::string browser()
{
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
        if (runCommand(std::string("command -v ") + name).code == 0) return name;
    return {};
}

/// The page as it stands once its scripts have run, and what it said on the console; no name resolves and no proxy answers.
CommandOutcome opened(const std::string& chromium, const ScratchFolder& folder, const std::string& page)
{
    folder.write("report.html", page);
    return runCommand("timeout 60 " + chromium +
                      " --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking --disable-component-update "
                      "--disable-sync --disable-dev-shm-usage --proxy-server=127.0.0.1:9 --host-resolver-rules='MAP * ~NOTFOUND' --enable-logging=stderr "
                      "--window-size=1400,2400 "
                      "--virtual-time-budget=10000 --user-data-dir='" +
                      folder.path("profile") + "' --dump-dom 'file://" + folder.path("report.html") + "'");
}

/// Points at the middle of the first dataset's first point of each chart and writes down what came of it.
constexpr const char* kProbe = R"(<script>
addEventListener('load', () => setTimeout(() => {
  const say = (id, text) => { const e = document.createElement('output'); e.id = id; e.textContent = '[' + text + ']'; document.body.append(e); };
  const boxes = [...document.querySelectorAll('figure.chart')];
  say('charts', boxes.length);
  say('resources', performance.getEntriesByType('resource').filter(r => !r.name.startsWith('data:')).length);
  const copy = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
  const inked = c => {
    copy.canvas.width = c.width; copy.canvas.height = c.height; copy.drawImage(c, 0, 0);
    const d = copy.getImageData(0, 0, c.width, c.height).data;
    let n = 0; for (let i = 3; i < d.length; i += 4) n += d[i] > 0;
    return n;
  };
  say('blank', boxes.filter(b => b.querySelector('canvas').width > 0 && inked(b.querySelector('canvas')) < 1000).length);
  document.querySelectorAll('details').forEach(d => d.open = true);
  setTimeout(() => {
    boxes.forEach(b => b.chart.resize());
    say('blankOpened', boxes.filter(b => inked(b.querySelector('canvas')) < 1000).length);
    const chart = boxes[0].chart;
    chart.canvas.scrollIntoView();
    // The page may still be laying itself out: point again until something shows.
    const point = left => {
      const dot = chart.getDatasetMeta(0).data[0], at = chart.canvas.getBoundingClientRect(), tip = document.getElementById('chart-tip');
      chart.canvas.dispatchEvent(new MouseEvent('mousemove', { clientX: at.left + dot.x, clientY: at.top + dot.y, bubbles: true }));
      if (tip.hidden && left > 0) return setTimeout(point, 100, left - 1);
      setTimeout(() => {
        const image = tip.querySelector('img');
        say('tipShown', !tip.hidden && tip.offsetHeight > 20);
        say('tipText', tip.textContent);
        say('tipPictures', tip.querySelectorAll('img').length + ' of ' + (image && image.naturalWidth));
      }, 100);
    };
    point(40);
  }, 500);
}, 100));
</script>)";

}  // namespace

TEST_CASE("the report tells scenes, fronts, effects and the path tracer", "[sweep][report]")
{
    const ScratchFolder folder;
    const std::string page = sweepReportHtml(syntheticSweep(3), folder.path("."));
    for (const char* part :
         {"scene0: error against time", "scene2: error against memory", "All scenes: error against time", "noise floor", "calibration frames (10 ms here)",
          "path tracer", "33 LRSM rows and 33 path tracer rows on 3 scenes", "wins both", "changes nothing", "320 x 180"})
        CHECK(contains(page, part));
    // Useless values are coloured; memory saved is worth something.
    CHECK(contains(page, "<tr class=\"failed\"><td>mip_filter=max</td>"));
    CHECK(contains(page, "<tr><td>cone_count=12</td>"));
    for (const char* reference : {"src=\"http", "href=\"http", "@import", "url(http"}) CHECK(!contains(page, reference));
}

TEST_CASE("the tables for Markdown hold presets, settings over all scenes, and effects", "[sweep][report]")
{
    const std::string tables = sweepTablesMarkdown(syntheticSweep(3));
    for (const char* part :
         {"## Scenes\n\n| scene |", "## Presets, scene by scene", "## All scenes: over balanced", "## One setting at a time", "## Changes nothing"})
        CHECK(contains(tables, part));
    // Over balanced's: a quarter of the time and twice the error in every scene.
    CHECK(contains(tables, "| fast | 0.25 (0.25 .. 0.25) | 2 (2 .. 2) | 0.98 .. 0.98 | 0.5 | yes | 2 | 2 | 2 |\n"));
    CHECK(contains(tables, "| cone_count=12 | 2 (2 .. 2) | 0.8 (0.8 .. 0.8) | 0.992 .. 0.992 | 1 |  | 0.8 | 0.8 | 0.8 |\n"));
    CHECK(contains(tables, "| scene0 | balanced | 0.99 | 10 | 7 | 0.05 | 8 | 1 | 100 |"));
    CHECK(contains(tables, "| density_k=1 | balanced | 3 |"));
    CHECK(sweepTablesMarkdown({}).empty());
}

TEST_CASE("a sweep in progress has a report too", "[sweep][report]")
{
    const std::vector<Measurement> whole = syntheticSweep(2);
    CHECK(contains(sweepReportHtml({}, "/nonexistent"), "0 LRSM rows"));
    // Each beginning, and each way to lack something.
    for (std::size_t n = 1; n < whole.size(); n += 3) {
        const std::vector<Measurement> begun(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
        CHECK(contains(sweepReportHtml(begun, "/nonexistent"), "</html>"));
        CHECK(contains(sweepTablesMarkdown(begun), "## Scenes"));
    }
    const auto without = [&](auto drop) {
        std::vector<Measurement> rows = whole;
        std::erase_if(rows, drop);
        return sweepReportHtml(rows, "/nonexistent");
    };
    CHECK(contains(without([](const Measurement& row) { return row.kind == RowKind::preset; }), "</html>"));
    CHECK(contains(without([](const Measurement& row) { return row.kind == RowKind::pathTracer; }), "</html>"));
    CHECK(contains(without([](const Measurement& row) { return row.kind != RowKind::pathTracer; }), "</html>"));
    CHECK(!contains(without([](const Measurement& row) { return row.scene == "scene1"; }), "All scenes"));
}

TEST_CASE("text of a row cannot leave its place in the report", "[sweep][report]")
{
    std::vector<Measurement> rows = syntheticSweep(1);
    for (Measurement& row : rows) row.scene = "</script><script>alert(1)</script>";
    CHECK(!contains(sweepReportHtml(rows, "/nonexistent"), "<script>alert"));
}

TEST_CASE("the report carries each thumbnail once", "[sweep][report]")
{
    const ScratchFolder folder;
    const std::vector<Measurement> rows = syntheticSweep(2);
    writeThumbnails(folder, rows);
    CHECK(count(sweepReportHtml(rows, folder.path(".")), "data:image/png") == rows.size() + 2);
}

TEST_CASE("thumbnails beyond the page's budget stay in the folder, those of the front first inside", "[sweep][report]")
{
    const ScratchFolder folder;
    const std::vector<Measurement> rows = syntheticSweep(1);
    // 22 files of 1 MB where 8 MB fit: presets, front, path tracer.
    for (const Measurement& row : rows)
        folder.write("thumbnails/" + row.key + ".png", std::string(1'000'000, row.label == "step=0.25" ? 'a' : row.label == "mip_filter=max" ? 'b' : 'c'));
    const std::string page = sweepReportHtml(rows, folder.path("."));
    CHECK(count(page, "data:image/png") == 8);
    CHECK(contains(page, "8 of 22 thumbnails"));
    CHECK(contains(page, "YWFhYWFh"));   // base64 of "aaaaaa"
    CHECK(!contains(page, "YmJiYmJi"));  // of "bbbbbb"
    CHECK(page.size() < 15'000'000);
}

TEST_CASE("a browser without a network draws the report and shows a point's thumbnail", "[sweep][report]")
{
    const std::string chromium = browser();
    if (chromium.empty()) {
        WARN("SKIPPED: no chromium (Debian: chromium)");
        return;
    }
    const ScratchFolder folder;
    const std::vector<Measurement> rows = syntheticSweep(2);
    writeThumbnails(folder, rows);
    std::string page = sweepReportHtml(rows, folder.path("."));
    page.insert(page.rfind("</body>"), kProbe);
    // A browser in virtual time may never come to draw a frame: what waits for one waits for a timer here.
    page.insert(page.find("<head>") + 6, "<script>window.requestAnimationFrame = f => setTimeout(() => f(performance.now()), 1);</script>");
    const CommandOutcome outcome = opened(chromium, folder, page);
    REQUIRE(outcome.code == 0);
    INFO(outcome.text.substr(outcome.text.find("CONSOLE") == std::string::npos ? outcome.text.size() : outcome.text.find("CONSOLE"), 300));
    CHECK(!contains(outcome.text, "CONSOLE"));
    const auto said = [&](const std::string& id) {
        const std::size_t at = outcome.text.find("<output id=\"" + id + "\">[");
        if (at == std::string::npos) return std::string("nothing");
        const std::size_t begin = outcome.text.find('[', at) + 1;
        return outcome.text.substr(begin, outcome.text.find("]</output>", begin) - begin);
    };
    CHECK(said("charts") == "10");
    CHECK(said("resources") == "0");
    CHECK(said("blank") == "0");
    CHECK(said("blankOpened") == "0");
    CHECK(said("tipShown") == "true");
    // The first chart's first point is the preset that comes first by name, over both scenes: two thumbnails.
    CHECK(contains(said("tipText"), "accurate"));
    CHECK(contains(said("tipText"), "error 0.5, time 4"));
    CHECK(said("tipPictures") == "2 of 160");
}
