#include "apps/sweep/sweep_charts.h"

#include "apps/sweep/sweep_tables.h"
#include "core/base/file.h"

#include <algorithm>
#include <filesystem>

namespace lrsm {
namespace {

namespace fs = std::filesystem;

/// What one point of a plot is, whichever plot.
struct Dot {
    const Measurement* row = nullptr;  ///< names and settings; over all cases that of the first
    double x = 0.0, y = 0.0;
    std::string hover;
    std::vector<int> pictures;
};

constexpr const char* kGrey = "#8c8c8c";

void addDot(ChartSeries& series, const Dot& dot)
{
    series.x.push_back(dot.x);
    series.y.push_back(dot.y);
    series.hover.push_back(dot.hover);
    series.pictures.push_back(dot.pictures);
}

ChartSeries seriesOf(const std::string& label, bool line, bool dashed, const std::string& marker, double size, const std::string& colour)
{
    return {.label = label, .line = line, .dashed = dashed, .marker = marker, .markerSize = size, .colour = colour};
}

/// Each preset a series of its own, with a colour and a mark that are the same in every plot.
std::vector<ChartSeries> presetSeries(const std::vector<Dot>& settings)
{
    constexpr const char* colours[] = {"#ee6677", "#ccaa22", "#aa3377", "#66aadd", "#ee8866"};
    constexpr const char* markers[] = {"triangle", "rect", "rectRot", "star", "crossRot"};
    std::vector<std::string> names;
    for (const Dot& dot : settings)
        if (dot.row->kind == RowKind::preset) names.push_back(dot.row->label);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    std::vector<ChartSeries> all;
    for (std::size_t i = 0; i < names.size(); ++i) {
        all.push_back(seriesOf(names[i], false, false, markers[i % 5], 8.0, colours[i % 5]));
        for (const Dot& dot : settings)
            if (dot.row->kind == RowKind::preset && dot.row->label == names[i]) addDot(all.back(), dot);
    }
    return all;
}

ChartSeries levelSeries(const std::string& label, double level, const std::vector<Dot>& settings, const std::vector<Dot>& tracer)
{
    ChartSeries series = seriesOf(label, true, true, "line", 0.0, "#999999");
    std::vector<double> x;
    for (const auto* dots : {&settings, &tracer})
        for (const Dot& dot : *dots)
            if (dot.x > 0.0) x.push_back(dot.x);
    if (x.empty() || !(level > 0.0)) return series;
    const auto [least, most] = std::minmax_element(x.begin(), x.end());
    series.x = {*least, *most};
    series.y = {level, level};
    return series;
}

/// Whether there is one: not where the best is neither least nor most.
enum class Front { drawn, none };

/// The first series is drawn on top.
Chart chartOf(const std::string& title, const std::string& xLabel, const std::string& yLabel, const std::vector<Dot>& settings, const std::vector<Dot>& tracer,
              Front front = Front::drawn)
{
    Chart chart{title, xLabel, yLabel, true, true, presetSeries(settings)};
    std::vector<CostError> points;
    for (const Dot& dot : settings) points.push_back({dot.x, dot.y});
    const std::vector<std::size_t> onFront = front == Front::drawn ? paretoFront(points) : std::vector<std::size_t>{};
    ChartSeries line = seriesOf("front", true, false, "", 4.0, "#4477aa"), others = seriesOf("settings", false, false, "", 2.5, kGrey),
                paths = seriesOf("path tracer", true, true, "", 4.0, "#228833");
    for (const std::size_t i : onFront) addDot(line, settings[i]);
    for (std::size_t i = 0; i < settings.size(); ++i)
        if (settings[i].row->kind != RowKind::preset && std::find(onFront.begin(), onFront.end(), i) == onFront.end()) addDot(others, settings[i]);
    for (const Dot& dot : tracer) addDot(paths, dot);
    for (ChartSeries* series : {&line, &others, &paths})
        if (!series->x.empty()) chart.series.push_back(std::move(*series));
    return chart;
}

/// A preset's name is its series'.
std::string settingsLine(const Measurement& row)
{
    return (row.kind == RowKind::pathTracer ? "" : "against balanced: ") + changedText(row);
}

std::string hoverOf(const Measurement& row)
{
    std::string text = settingsLine(row) + "\nerror " + percentText(row.error.net());
    if (row.error.net() <= row.error.noise) text += " (<= floor)";
    text += ", FLIP " + shortNumber(row.error.flip) + ", energy " + shortNumber(row.error.energy) + "\ntime " + plainNumber(row.cost) +
            " calibration frames; here " + plainNumber(row.frame.median) + " ms, " + plainNumber(row.frameCpu) + " ms of processor time";
    if (row.bytes) text += "\nmemory " + plainNumber(static_cast<double>(row.bytes) / 1e6) + " MB";
    if (row.gpuBytes) text += ", " + plainNumber(static_cast<double>(row.gpuBytes) / 1e6) + " MB in the GPU's formats";
    return text;
}

using Figure = double (*)(const Measurement&);

std::vector<Dot> dotsOf(const std::vector<const Measurement*>& rows, const SweepPictures& pictures, Figure x, Figure y)
{
    std::vector<Dot> dots;
    for (const Measurement* row : rows) {
        Dot dot{row, x(*row), y(*row), hoverOf(*row), pictures.of(row->key)};
        const std::vector<int> truth = pictures.of(row->caseKey);
        if (!dot.pictures.empty() && !truth.empty()) {
            dot.pictures.push_back(truth.front());
            dot.hover += "\nthis, and the truth:";
        }
        dots.push_back(std::move(dot));
    }
    return dots;
}

constexpr auto costOf = [](const Measurement& row) { return row.cost; };
constexpr auto percentErrorOf = [](const Measurement& row) { return 100.0 * row.error.net(); };
constexpr auto megabytesOf = [](const Measurement& row) { return static_cast<double>(row.bytes) / 1e6; };
constexpr auto flipOf = [](const Measurement& row) { return row.error.flip; };
constexpr auto energyOf = [](const Measurement& row) { return row.error.energy; };

double noiseOf(const CaseRows& rows)
{
    return (rows.settings.empty() ? rows.pathTracer.front() : rows.settings.front())->error.noise;
}

std::string withFloor(Chart chart, double floor, const std::vector<Dot>& settings, const std::vector<Dot>& tracer)
{
    if (ChartSeries level = levelSeries("noise floor", floor, settings, tracer); !level.x.empty()) chart.series.push_back(std::move(level));
    return chartHtml(chart);
}

std::vector<Dot> combinedDots(const std::vector<CombinedRow>& rows, const CombinedCases& all, const SweepPictures& pictures, double (*x)(const CombinedRow&))
{
    std::vector<Dot> dots;
    for (const CombinedRow& row : rows) {
        Dot dot{row.rows.front(), x(row), row.error, {}, {}};
        dot.hover = settingsLine(*dot.row) + "\nover balanced: error " + shortNumber(row.error) + ", time " + shortNumber(row.cost);
        if (dot.row->bytes) dot.hover += ", memory " + shortNumber(row.bytes);
        for (std::size_t i = 0; i < row.rows.size(); ++i) {
            dot.hover += "\n" + all.cases[i]->name + ": " + percentText(row.rows[i]->error.net()) + ", " + shortNumber(row.rows[i]->cost) + " frames";
            for (const int picture : pictures.of(row.rows[i]->key)) dot.pictures.push_back(picture);
        }
        dots.push_back(std::move(dot));
    }
    return dots;
}

/// Rows whose thumbnails matter most.
void addShown(std::vector<const Measurement*>& shown, const std::vector<const Measurement*>& rows)
{
    for (const Measurement* row : rows)
        if (std::find(shown.begin(), shown.end(), row) == shown.end()) shown.push_back(row);
}

std::vector<const Measurement*> mostWanted(const std::vector<CaseRows>& cases, const CombinedCases& all)
{
    std::vector<const Measurement*> wanted;
    for (const CaseRows& one : cases) {
        std::vector<const Measurement*> presets;
        std::copy_if(one.settings.begin(), one.settings.end(), std::back_inserter(presets),
                     [](const Measurement* row) { return row->kind == RowKind::preset; });
        addShown(wanted, presets);
    }
    for (const CaseRows& one : cases)
        for (const auto& rows : {timeFront(one), one.pathTracer, memoryFront(one)}) addShown(wanted, rows);
    for (const CombinedRow* row : combinedFront(all)) addShown(wanted, row->rows);
    return wanted;
}

}  // namespace

std::vector<int> SweepPictures::of(const std::string& key) const
{
    const auto place = byKey.find(key);
    return place == byKey.end() ? std::vector<int>{} : std::vector<int>{place->second};
}

SweepPictures loadThumbnails(const std::vector<CaseRows>& cases, const CombinedCases& all, const std::string& directory, std::size_t budget)
{
    const auto fileOf = [&](const std::string& key) { return fs::path(directory) / "thumbnails" / (key + ".png"); };
    const auto sizeOf = [&](const std::string& key) -> std::size_t {
        std::error_code error;
        const auto size = fs::file_size(fileOf(key), error);
        return error ? 0 : static_cast<std::size_t>(size);
    };
    std::vector<const Measurement*> rows = mostWanted(cases, all);
    for (const CaseRows& one : cases) addShown(rows, one.settings);
    std::vector<std::string> keys;
    for (const CaseRows& one : cases) keys.push_back(one.caseKey);
    for (const Measurement* row : rows) keys.push_back(row->key);
    SweepPictures pictures;
    std::size_t held = 0;
    for (const std::string& key : keys) {
        const std::size_t size = sizeOf(key);
        pictures.found += size > 0 ? 1 : 0;
        if (size == 0 || held + size > budget) continue;
        held += size;
        const std::vector<unsigned char> bytes = readFile(fileOf(key).string());
        std::vector<std::byte> png(bytes.size());
        std::transform(bytes.begin(), bytes.end(), png.begin(), [](unsigned char b) { return std::byte(b); });
        pictures.byKey.emplace(key, static_cast<int>(pictures.pngs.size()));
        pictures.pngs.push_back(std::move(png));
    }
    return pictures;
}

std::string caseCharts(const CaseRows& rows, const SweepPictures& pictures, const std::string& timeUnit)
{
    const auto settings = dotsOf(rows.settings, pictures, costOf, percentErrorOf), tracer = dotsOf(rows.pathTracer, pictures, costOf, percentErrorOf);
    const auto memory = dotsOf(rows.settings, pictures, megabytesOf, percentErrorOf);
    const double floor = 100.0 * noiseOf(rows);
    return withFloor(chartOf(rows.name + ": error against time", timeUnit, "error, % of the mean", settings, tracer), floor, settings, tracer) +
           withFloor(chartOf(rows.name + ": error against memory", "memory, MB", "error, % of the mean", memory, {}), floor, memory, {});
}

std::string otherMetricCharts(const CaseRows& rows, const SweepPictures& pictures, const std::string& timeUnit)
{
    const auto settings = dotsOf(rows.settings, pictures, costOf, energyOf), tracer = dotsOf(rows.pathTracer, pictures, costOf, energyOf);
    Chart flip = chartOf(rows.name + ": FLIP against time", timeUnit, "mean FLIP", dotsOf(rows.settings, pictures, costOf, flipOf),
                         dotsOf(rows.pathTracer, pictures, costOf, flipOf));
    Chart energy = chartOf(rows.name + ": energy against time", timeUnit, "energy over the truth's", settings, tracer, Front::none);
    energy.logY = false;
    energy.series.push_back(levelSeries("truth", 1.0, settings, tracer));
    return chartHtml(flip) + chartHtml(energy);
}

std::string combinedCharts(const CombinedCases& all, const SweepPictures& pictures)
{
    const auto cost = [](const CombinedRow& row) { return row.cost; };
    const auto bytes = [](const CombinedRow& row) { return row.bytes; };
    const auto settings = combinedDots(all.settings, all, pictures, cost), tracer = combinedDots(all.pathTracer, all, pictures, cost);
    const auto memory = combinedDots(all.settings, all, pictures, bytes);
    return withFloor(chartOf("All scenes: error against time", "time over balanced's", "error over balanced's", settings, tracer), all.noise, settings,
                     tracer) +
           withFloor(chartOf("All scenes: error against memory", "memory over balanced's", "error over balanced's", memory, {}), all.noise, memory, {});
}

}  // namespace lrsm
