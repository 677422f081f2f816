#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Plots in a page, drawn by Chart.js (MIT licence), which the page carries with it.
namespace lrsm {

struct ChartSeries {
    std::string label;
    std::vector<double> x = {}, y = {};   ///< of equal length; a point that is not finite (or not positive on a logarithmic axis) is left out
    std::vector<std::string> hover = {};  ///< a text a point, shown under the pointer; lines end with "\n"; may be empty
    bool line = true;                     ///< joined in order of x; else points alone
    bool dashed = false;
    std::vector<std::vector<int>> pictures = {};  ///< a list a point, of indices into chartPictures(), shown below the text; may be empty
    std::string marker = {};                      ///< "circle" (as is empty), "triangle", "rect", "rectRot", "star", "cross", "crossRot", "line"
    double markerSize = -1.0;                     ///< radius, CSS pixels; 0: no points; below 0: 2 on lines, 4 elsewhere
    std::string colour = {};                      ///< "#rrggbb"; empty: the palette's, by the series' place
};

struct Chart {
    std::string title, xLabel, yLabel;
    bool logX = false, logY = false;
    std::vector<ChartSeries> series = {};
};

/// A figure of at most 620 x 400 CSS pixels; several in a row flow side by side. The page's script must hold chartScript().
std::string chartHtml(const Chart& chart);

/// Bars: one group a category, one bar a series.
struct BarChart {
    std::string title, yLabel;
    std::vector<std::string> categories;
    struct Series {
        std::string label;
        std::vector<double> values;  ///< one a category
    };
    std::vector<Series> series;
    bool logY = false;
};
std::string chartHtml(const BarChart& chart);

/// Chart.js itself (200 kB) and the lines that draw each figure: HtmlPage::script of a page with charts.
std::string chartScript();
/// Pictures (PNG) that a page's charts show under the pointer: stands once in the page's body, however many charts show them.
std::string chartPictures(const std::vector<std::vector<std::byte>>& pngs);
/// HtmlPage::style of a page with charts.
std::string chartStyle();

}  // namespace lrsm
