#include "core/report/chart.h"
#include "core/report/comparison.h"
#include "core/report/table.h"

#include <catch.h>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

using namespace lrsm;

namespace {

/// The configuration that a figure carries, as a browser would read it.
nlohmann::json configOf(const std::string& html)
{
    const std::string open = "<script type=\"application/json\">";
    const std::size_t begin = html.find(open) + open.size();
    return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

}  // namespace

TEST_CASE("text cannot leave its element", "[report]")
{
    const std::string hostile = "</script><script>alert(\"1\")</script>&";
    CHECK(htmlEscaped(hostile).find_first_of("<>\"") == std::string::npos);

    Chart chart{hostile, hostile, hostile, false, false, {{hostile, {1.0}, {2.0}, {hostile}}}};
    const std::string html = chartHtml(chart);
    CHECK(html.find("<script>alert") == std::string::npos);
    const auto config = configOf(html);
    CHECK(config["data"]["datasets"][0]["label"] == hostile);
    CHECK(config["data"]["datasets"][0]["data"][0]["hover"] == hostile);
}

TEST_CASE("a chart leaves out what its axes cannot show", "[report]")
{
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    const ChartSeries series{"s", {1.0, 2.0, nan, 4.0, 0.0}, {1.0, inf, 1.0, -1.0, 1.0}};
    const auto linear = configOf(chartHtml(Chart{"t", "x", "y", false, false, {series}}));
    CHECK(linear["data"]["datasets"][0]["data"].size() == 3);
    const auto logarithmic = configOf(chartHtml(Chart{"t", "x", "y", true, true, {series}}));
    REQUIRE(logarithmic["data"]["datasets"][0]["data"].size() == 1);
    CHECK(logarithmic["data"]["datasets"][0]["data"][0]["x"] == 1.0);
    CHECK(logarithmic["options"]["scales"]["x"]["type"] == "logarithmic");

    const auto bars = configOf(chartHtml(BarChart{"t", "y", {"a", "b"}, {{"s", {nan, 2.0}}}}));
    CHECK(bars["data"]["datasets"][0]["data"][0].is_null());
    CHECK(bars["data"]["datasets"][0]["data"][1] == 2.0);
}

TEST_CASE("a page asks nothing of a network", "[report]")
{
    const std::string page = htmlPage({"title", "summary", chartHtml(Chart{"t", "x", "y", false, false, {{"s", {1.0}, {1.0}}}}), chartStyle(), chartScript()});
    for (const char* reference : {"src=\"http", "href=\"http", "@import", "url(http"}) CHECK(page.find(reference) == std::string::npos);
    CHECK(page.find("Chart.js v") != std::string::npos);
    // One closing tag for the figure's data and one for the page's script: nothing inside ends either early.
    std::size_t closed = 0;
    for (std::size_t at = 0; (at = page.find("</script>", at)) != std::string::npos; ++at) ++closed;
    CHECK(closed == 2);
}

TEST_CASE("a failed row is marked and shows no mark of its own", "[report]")
{
    const std::string html = tableHtml({"t", {"a", "b"}, {{"!bad", "1"}, {"good", "2"}}});
    CHECK(html.find("<tr class=\"failed\"><td>bad</td>") != std::string::npos);
    CHECK(html.find("<tr><td>good</td>") != std::string::npos);
}

TEST_CASE("a table aligns numbers to the right and counts characters, not bytes", "[report]")
{
    const ReportTable table{"t", {"name", "value"}, {{"\u03b1", "1"}, {"bc", "-22"}}};
    CHECK(textTable(table) == "t\n  name  value\n  \u03b1         1\n  bc      -22\n");
    CHECK(textTable({"t", {"name"}, {}}).empty());
}

TEST_CASE("a CSV cell comes back whole", "[report]")
{
    CHECK(csvTable({"", {"a"}, {{"1"}}}, "\r\n") == "a\r\n1\r\n");
    CHECK(markdownTable({"not written", {"a", "b"}, {{"1", "x|y"}, {"2"}}}) == "| a | b |\n| --- | --- |\n| 1 | x\\|y |\n| 2 |  |\n");
    CHECK(csvTable({"not written", {"a", "b"}, {{"1,5", "say \"x\""}, {"two\nlines", ""}}}) == "a,b\n\"1,5\",\"say \"\"x\"\"\"\n\"two\nlines\",\n");
    for (const double value : {0.1, 1.0 / 3.0, 5e-324, -1.7976931348623157e308}) CHECK(std::strtod(exactNumber(value).c_str(), nullptr) == value);
}
