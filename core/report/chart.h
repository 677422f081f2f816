#pragma once

#include <string>
#include <vector>

/// Plots in a page, drawn by Chart.js (MIT licence), which the page carries with it.
namespace lrsm {

struct ChartSeries {
    std::string label;
    std::vector<double> x, y;         ///< of equal length; a point that is not finite (or not positive on a logarithmic axis) is left out
    std::vector<std::string> hover = {};  ///< a line a point, shown under the pointer; may be empty
    bool line = true;                 ///< joined in order of x; else points alone
    bool dashed = false;
};

struct Chart {
    std::string title, xLabel, yLabel;
    bool logX = false, logY = false;
    std::vector<ChartSeries> series;
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
/// HtmlPage::style of a page with charts.
std::string chartStyle();

}  // namespace lrsm
