#include "core/report/chart.h"

#include "core/report/html.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lrsm {

/// Text of the installed chart.min.js; its unit is written when the build is configured.
extern const char* const kChartJs;

namespace {

using Json = nlohmann::ordered_json;

Json axis(const std::string& label, bool logarithmic)
{
    return {{"type", logarithmic ? "logarithmic" : "linear"}, {"title", {{"display", !label.empty()}, {"text", label}}}};
}

bool drawable(double value, bool logarithmic)
{
    return std::isfinite(value) && (!logarithmic || value > 0.0);
}

Json points(const ChartSeries& series, const Chart& chart)
{
    Json list = Json::array();
    for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i) {
        if (!drawable(series.x[i], chart.logX) || !drawable(series.y[i], chart.logY)) continue;
        Json point = {{"x", series.x[i]}, {"y", series.y[i]}};
        if (i < series.hover.size()) point["hover"] = series.hover[i];
        list.push_back(std::move(point));
    }
    return list;
}

Json dataset(const ChartSeries& series, const Chart& chart)
{
    Json set = {{"label", series.label}, {"data", points(series, chart)}, {"showLine", series.line}, {"borderWidth", 2}};
    set["pointRadius"] = series.line ? 2 : 4;
    if (series.dashed) set["borderDash"] = {6, 4};
    return set;
}

/// The configuration stands in the page as data; "<" is written so that no text can end the script element.
std::string figure(const std::string& title, const Json& config)
{
    std::string json = config.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
    return "<figure class=\"chart\"><figcaption>" + htmlEscaped(title) + "</figcaption><div><canvas role=\"img\" aria-label=\"" + htmlEscaped(title) +
           "\"></canvas></div><script type=\"application/json\">" + json + "</script></figure>\n";
}

constexpr const char* kDraw = R"(
{
  const palette = ['#4477aa', '#ee6677', '#228833', '#ccbb44', '#66ccee', '#aa3377', '#bbbbbb', '#ee8866', '#44bb99', '#99ddff'];
  Chart.defaults.color = matchMedia('(prefers-color-scheme: dark)').matches ? '#ddd' : '#333';
  Chart.defaults.borderColor = '#8884';
  for (const box of document.querySelectorAll('figure.chart')) {
    const config = JSON.parse(box.querySelector('script').textContent);
    config.data.datasets.forEach((set, i) => {
      set.borderColor = palette[i % palette.length];
      set.backgroundColor = set.borderColor + (config.type === 'bar' ? 'cc' : '88');
    });
    // Powers of ten alone are written on a logarithmic axis, short.
    const power = v => { const e = Math.round(Math.log10(v)); return Math.abs(Math.log10(v) - e) > 1e-9 ? '' : Math.abs(e) > 3 ? '1e' + e : String(v); };
    for (const axis of Object.values(config.options.scales)) if (axis.type === 'logarithmic') axis.ticks = { callback: power };
    config.options.plugins.tooltip = { callbacks: { afterLabel: item => item.raw && item.raw.hover } };
    box.chart = new Chart(box.querySelector('canvas'), config);
  }
}
)";

Json options(bool legend)
{
    return {{"animation", false}, {"maintainAspectRatio", false}, {"plugins", {{"legend", {{"display", legend}}}}}};
}

}  // namespace

std::string chartHtml(const Chart& chart)
{
    Json sets = Json::array();
    for (const ChartSeries& series : chart.series) sets.push_back(dataset(series, chart));
    Json config = {{"type", "scatter"}, {"data", {{"datasets", std::move(sets)}}}, {"options", options(chart.series.size() > 1)}};
    config["options"]["scales"] = {{"x", axis(chart.xLabel, chart.logX)}, {"y", axis(chart.yLabel, chart.logY)}};
    return figure(chart.title, config);
}

std::string chartHtml(const BarChart& chart)
{
    Json sets = Json::array();
    for (const BarChart::Series& series : chart.series) {
        Json values = Json::array();
        for (const double value : series.values) values.push_back(drawable(value, chart.logY) ? Json(value) : Json());
        sets.push_back({{"label", series.label}, {"data", std::move(values)}});
    }
    Json config = {{"type", "bar"}, {"data", {{"labels", chart.categories}, {"datasets", std::move(sets)}}}, {"options", options(chart.series.size() > 1)}};
    config["options"]["scales"] = {{"y", axis(chart.yLabel, chart.logY)}};
    return figure(chart.title, config);
}

std::string chartScript()
{
    return std::string(kChartJs) + kDraw;
}

std::string chartStyle()
{
    return "figure.chart { display: inline-block; width: 620px; max-width: 100%; vertical-align: top; margin: 0 8px 1em 0; }"
           "figure.chart div { height: 360px; } figure.chart figcaption { font-weight: 600; }\n";
}

}  // namespace lrsm
