#include "core/report/chart.h"

#include "core/report/html.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

/// Some room beyond the first and last value, so that no point is cut in half; nothing without values.
void padLogarithmic(Json& scale, const Chart& chart, std::vector<double> ChartSeries::*values)
{
    double min = std::numeric_limits<double>::infinity(), max = 0.0;
    for (const ChartSeries& series : chart.series)
        for (const double value : series.*values)
            if (drawable(value, true)) {
                min = std::min(min, value);
                max = std::max(max, value);
            }
    if (!(max > 0.0)) return;
    const double room = std::pow(max / min, 0.04) * 1.05;
    scale["min"] = min / room;
    scale["max"] = max * room;
}

Json points(const ChartSeries& series, const Chart& chart)
{
    Json list = Json::array();
    for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i) {
        if (!drawable(series.x[i], chart.logX) || !drawable(series.y[i], chart.logY)) continue;
        Json point = {{"x", series.x[i]}, {"y", series.y[i]}};
        if (i < series.hover.size()) point["hover"] = series.hover[i];
        if (i < series.pictures.size() && !series.pictures[i].empty()) point["pictures"] = series.pictures[i];
        list.push_back(std::move(point));
    }
    return list;
}

Json dataset(const ChartSeries& series, const Chart& chart)
{
    Json set = {{"label", series.label}, {"data", points(series, chart)}, {"showLine", series.line}, {"borderWidth", 2}};
    set["pointRadius"] = series.markerSize >= 0.0 ? series.markerSize : series.line ? 2.0 : 4.0;
    if (!series.marker.empty()) set["pointStyle"] = series.marker;
    if (!series.colour.empty()) set["borderColor"] = series.colour;
    if (series.dashed) set["borderDash"] = {6, 4};
    return set;
}

/// Data within a page; "<" is written so that no text can end the script element.
std::string embedded(const Json& data)
{
    std::string json = data.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
    return json;
}

std::string figure(const std::string& title, const Json& config)
{
    return "<figure class=\"chart\"><figcaption>" + htmlEscaped(title) + "</figcaption><div><canvas role=\"img\" aria-label=\"" + htmlEscaped(title) +
           "\"></canvas></div><script type=\"application/json\">" + embedded(config) + "</script></figure>\n";
}

// The text under the pointer is an element of the page, not of the canvas, so that it can hold pictures and its text can be as long as it is.
constexpr const char* kDraw = R"(
{
  const palette = ['#4477aa', '#ee6677', '#228833', '#ccbb44', '#66ccee', '#aa3377', '#bbbbbb', '#ee8866', '#44bb99', '#99ddff'];
  Chart.defaults.color = matchMedia('(prefers-color-scheme: dark)').matches ? '#ddd' : '#333';
  Chart.defaults.borderColor = '#8884';
  Chart.defaults.font.family = 'system-ui, sans-serif';
  const stored = document.getElementById('chart-pictures');
  const pictures = stored ? JSON.parse(stored.textContent) : [];
  const tip = document.createElement('div');
  tip.id = 'chart-tip';
  tip.hidden = true;
  document.body.append(tip);
  const put = (tag, text) => { const e = document.createElement(tag); e.textContent = text; tip.append(e); return e; };
  const show = ({ chart, tooltip }) => {
    tip.hidden = tooltip.opacity === 0;
    if (tip.hidden) return;
    tip.replaceChildren();
    const seen = new Set();
    for (const item of tooltip.dataPoints) {
      const text = item.raw.hover || item.formattedValue;
      if (seen.has(text) || seen.size === 3) continue;
      seen.add(text);
      put('b', item.dataset.label);
      put('div', text);
      for (const index of item.raw.pictures || []) put('img', '').src = pictures[index];
    }
    tip.classList.toggle('many', tip.querySelectorAll('img').length > 4);
    const at = chart.canvas.getBoundingClientRect(), x = at.left + tooltip.caretX, y = at.top + tooltip.caretY;
    tip.style.left = Math.max(4, x + 16 + tip.offsetWidth < innerWidth ? x + 16 : x - 16 - tip.offsetWidth) + 'px';
    tip.style.top = Math.max(4, Math.min(y + 16, innerHeight - tip.offsetHeight - 4)) + 'px';
  };
  // Powers of ten alone are written on a long logarithmic axis, 1, 2 and 5 of each on a short one.
  const power = function (v) {
    const e = Math.floor(Math.log10(v) + 1e-9), digit = Math.round(v / 10 ** e);
    if (!(this.max / this.min > 300 ? [1] : [1, 2, 5]).includes(digit) || Math.abs(v / 10 ** e - digit) > 1e-6) return '';
    return Math.abs(e) > 3 ? digit + 'e' + e : String(Number(v.toPrecision(1)));
  };
  for (const box of document.querySelectorAll('figure.chart')) {
    const config = JSON.parse(box.querySelector('script').textContent);
    config.data.datasets.forEach((set, i) => {
      set.borderColor = set.borderColor || palette[i % palette.length];
      set.backgroundColor = set.borderColor + (config.type === 'bar' ? 'cc' : '88');
    });
    for (const axis of Object.values(config.options.scales)) if (axis.type === 'logarithmic') axis.ticks = { callback: power, autoSkip: false, maxRotation: 0 };
    if (config.type === 'scatter') config.options.plugins.tooltip = { enabled: false, external: show };
    box.chart = new Chart(box.querySelector('canvas'), config);
    box.addEventListener('mouseleave', () => { tip.hidden = true; });
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
    if (chart.logX) padLogarithmic(config["options"]["scales"]["x"], chart, &ChartSeries::x);
    if (chart.logY) padLogarithmic(config["options"]["scales"]["y"], chart, &ChartSeries::y);
    config["options"]["plugins"]["legend"]["labels"] = {{"usePointStyle", true}, {"boxHeight", 7}, {"padding", 12}};
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

std::string chartPictures(const std::vector<std::vector<std::byte>>& pngs)
{
    Json list = Json::array();
    for (const auto& png : pngs) list.push_back(pngUri(png));
    return "<script type=\"application/json\" id=\"chart-pictures\">" + embedded(list) + "</script>\n";
}

std::string chartStyle()
{
    return "figure.chart { display: inline-block; width: 620px; max-width: 100%; vertical-align: top; margin: 0 8px 1em 0; }"
           "figure.chart div { height: 360px; } figure.chart figcaption { font-weight: 600; }"
           "#chart-tip { position: fixed; z-index: 9; pointer-events: none; max-width: 360px; padding: .4em .6em; border: 1px solid #888; border-radius: 4px;"
           " background: Canvas; color: CanvasText; font-size: 13px; line-height: 1.3; }"
           "#chart-tip div { white-space: pre-line; } #chart-tip img { max-width: 160px; margin: 4px 4px 0 0; vertical-align: top; } #chart-tip.many img { "
           "max-width: 112px; }\n";
}

}  // namespace lrsm
