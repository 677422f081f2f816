#include "apps/sweep/sweep_report.h"

#include "apps/sweep/sweep_charts.h"
#include "apps/sweep/sweep_tables.h"
#include "core/base/text.h"
#include "core/report/html.h"

#include <algorithm>

namespace lrsm {
namespace {

/// Bytes of PNGs; base64 makes 4/3 of it.
constexpr std::size_t kPictureBudget = 8'000'000;

std::string countOf(std::size_t count, const std::string& what)
{
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string summaryOf(const std::vector<Measurement>& rows, const std::vector<CaseRows>& cases, const CalibrationUnit& unit, double noise)
{
    std::size_t tracer = 0;
    for (const CaseRows& one : cases) tracer += one.pathTracer.size();
    std::string text = countOf(rows.size() - tracer, "LRSM row") + " and " + countOf(tracer, "path tracer row") + " on " + countOf(cases.size(), "scene") +
                       ". Errors are of the irradiance against a path-traced truth of one bounce: RMSE over the mean, the truth's own noise taken out; nothing "
                       "is claimed below its noise floor. Time is processor time in calibration frames, a fixed small frame rendered beside each measurement: ";
    text += "one is " + shortNumber(unit.median) + " ms here (" + shortNumber(unit.min) + " to " + shortNumber(unit.max) + " over the rows).";
    if (noise > 0.0)
        text += " Rows that equal their base in every bit differ from it in time by " + percentText(noise) +
                " (median): read no difference in time closer than that.";
    return text;
}

std::string picturesText(const SweepPictures& pictures)
{
    if (pictures.pngs.size() >= pictures.found) return {};
    return paragraphHtml("The page carries " + std::to_string(pictures.pngs.size()) + " of " + countOf(pictures.found, "thumbnail") +
                         ", those of presets, fronts and path tracer first; the others are in the folder thumbnails.");
}

std::string combinedHtml(const CombinedCases& all, const SweepPictures& pictures)
{
    if (all.cases.size() < 2) return {};
    const std::string names = joined(all.cases, &CaseRows::name);
    return headingHtml("All scenes") +
           paragraphHtml("Geometric means over " + names + " of each figure over that of balanced in the same scene; " +
                         countOf(all.settings.size(), "setting") + " measured on all of them.") +
           combinedCharts(all, pictures) + foldedHtml("In numbers", tableHtml(combinedTable(all)));
}

/// Less than twice what the clock makes of equal work is no difference of time.
double toleranceOf(const std::vector<CaseRows>& cases)
{
    return std::max(0.01, 2.0 * costNoise(cases));
}

std::string effectsHtml(const std::vector<CaseRows>& cases, double unit)
{
    const double tolerance = toleranceOf(cases);
    const std::vector<Effect> effects = effectsOf(cases, unit, tolerance);
    if (effects.empty()) return {};
    const ReportTable changing = effectsTable(effects), nothing = nothingTable(effects);
    return headingHtml("One setting at a time") +
           paragraphHtml(
               "Each value against its base: geometric mean over the scenes of the ratio of errors, of times and of bytes, less one. \"ms\" is the change of "
               "processor time (mean over the scenes). \"% of error a ms\": what a millisecond buys (buys accuracy, dearest last), or what a millisecond saved "
               "is paid with (saves time, cheapest first). Coloured rows lose in both and save no memory. Changes of time below " +
               percentText(tolerance) + " count as none.") +
           foldedHtml(countOf(changing.rows.size(), "value") + ", sorted by what a millisecond buys", tableHtml(changing)) +
           (nothing.rows.empty() ? ""
                                 : foldedHtml(countOf(nothing.rows.size(), "value") + (nothing.rows.size() == 1 ? " changes" : " change") +
                                                  " nothing: not one bit of the irradiance, in any scene",
                                              tableHtml(nothing)));
}

std::string rivalsHtml(const std::vector<CaseRows>& cases)
{
    const std::vector<EqualRow> presets = presetsAgainstPathTracer(cases);
    if (presets.empty()) return {};
    return headingHtml("Equal time and equal error: the path tracer") +
           paragraphHtml(
               "The path tracer's error in each preset's time, and its time (in calibration frames, as all here) for each preset's error, interpolated between "
               "its measured points in logarithms; ratios are the path tracer's figure over LRSM's: above 1 they speak for LRSM. \"<= floor\": at or below the "
               "truth's noise, where nothing is compared. \"> x\" and \"< x\": beyond the measured end of the curve, where no ratio is given.") +
           tableHtml(equalSummaryTable(summarizeEqual(presets))) +
           foldedHtml("Each preset against the path tracer, scene by scene", tableHtml(presetsTable(presets)), cases.size() == 1);
}

std::string caseHtml(const CaseRows& rows, const SweepPictures& pictures, const std::string& timeUnit)
{
    return headingHtml(rows.name) + caseCharts(rows, pictures, timeUnit) + foldedHtml("FLIP and energy", otherMetricCharts(rows, pictures, timeUnit)) +
           (rows.settings.empty() ? ""
                                  : foldedHtml("The front in numbers", tableHtml(frontTable("Error against time", timeFront(rows))) +
                                                                           tableHtml(frontTable("Error against memory", memoryFront(rows)))));
}

}  // namespace

std::string sweepReportHtml(const std::vector<Measurement>& rows, const std::string& directory)
{
    const std::vector<CaseRows> cases = casesOf(rows);
    const CombinedCases all = combineCases(cases);
    const CalibrationUnit unit = calibrationUnit(rows);
    const double noise = costNoise(cases);
    const SweepPictures pictures = loadThumbnails(cases, all, directory, kPictureBudget);
    const std::string timeUnit = "time, calibration frames (" + shortNumber(unit.median) + " ms here)";

    std::string body = cases.empty() ? "" : tableHtml(casesTable(cases));
    body += picturesText(pictures) + combinedHtml(all, pictures) + effectsHtml(cases, unit.median) + rivalsHtml(cases);
    for (const CaseRows& one : cases) body += caseHtml(one, pictures, timeUnit);
    body += chartPictures(pictures.pngs);
    return htmlPage({"The trade: error, time and memory", summaryOf(rows, cases, unit, noise), body, chartStyle(), chartScript()});
}

std::string sweepTablesMarkdown(const std::vector<Measurement>& rows)
{
    const std::vector<CaseRows> cases = casesOf(rows);
    const std::vector<Effect> effects = effectsOf(cases, calibrationUnit(rows).median, toleranceOf(cases));
    std::string text;
    for (const ReportTable& table :
         {casesTable(cases), presetsTable(presetsAgainstPathTracer(cases)), combinedTable(combineCases(cases)), effectsTable(effects), nothingTable(effects)})
        if (!table.rows.empty()) text += "## " + table.title + "\n\n" + markdownTable(table) + "\n";
    return text;
}

}  // namespace lrsm
