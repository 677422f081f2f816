#include "apps/sweep/measurement.h"

#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include "catch.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

using namespace lrsm;
using Json = nlohmann::ordered_json;

namespace {

Measurement fullRow()
{
    Measurement row;
    row.scene = "a \"scene\", with a comma";
    row.caseKey = "0123456789abcdef";
    row.key = "fedcba9876543210";
    row.label = "cone_count=4";
    row.base = "balanced";
    row.width = 320;
    row.height = 180;
    row.truthSamples = 4096;
    row.error = {1.0 / 3.0, 0.1 + 0.2, 0.05, 0.011, 0.0123};
    row.frame = {12.5, 11.0 / 7.0, 0.25};
    row.frameCpu = 24.75;
    row.calibrationCpu = 30.1;
    row.cost = 24.75 / 30.1;
    // Passes and counters that no frame has: none is known by name.
    for (const char* family : {"voxel mips", "lrsm", "invented pass"})
        row.passes.push_back({family, row.passes.size() == 2, {double(row.passes.size()) / 3.0, double(row.passes.size()) / 7.0, 0.5}});
    row.counters = {{"cone_steps", 0x1p52}, {"invented_taps", 3.0}};
    row.bytes = 123456789012;
    row.gpuBytes = 5;
    row.irradianceSha256 = "abc";
    row.settings = preset("literal");
    return row;
}

Measurement throughText(const Measurement& row)
{
    return measurementFromJson(Json::parse(measurementJson(row).dump()), "row");
}

}  // namespace

TEST_CASE("a row reads back from its JSON to the same text, every number to the last bit", "[sweep]")
{
    const Measurement row = fullRow(), again = throughText(row);
    CHECK(measurementJson(again).dump() == measurementJson(row).dump());
    CHECK(again.error.energy == row.error.energy);
    CHECK(again.error.rmse == row.error.rmse);
    CHECK(counterSum(again.counters, "cone_steps") == 0x1p52);
    CHECK(counterSum(again.counters, "invented_taps") == 3.0);
    CHECK(again.settings == row.settings);
    CHECK(again.kind == RowKind::axis);
    REQUIRE(again.passes.size() == 3);
    CHECK(again.passes[2].family == "invented pass");
    CHECK(again.passes[2].perPixel);
    CHECK_FALSE(again.passes[0].perPixel);
    CHECK(again.passes[2].time.min == 2.0 / 7.0);
}

TEST_CASE("the path tracer's row has no settings and no passes, what is not finite is null and reads back as NaN", "[sweep]")
{
    Measurement row;
    row.kind = RowKind::pathTracer;
    row.samples = 64;
    row.error.energy = std::numeric_limits<double>::infinity();
    const Json json = measurementJson(row);
    CHECK(json["cone_count"].is_null());
    CHECK(json["passes"].empty());
    CHECK(json["energy"].is_null());
    const Measurement again = throughText(row);
    CHECK(again.samples == 64);
    CHECK(again.passes.empty());
    CHECK(std::isnan(again.error.energy));
    CHECK(measurementJson(again).dump() == json.dump());
}

TEST_CASE("a row's columns: what every row has, its passes and counters whatever they are, the settings, no name twice", "[sweep]")
{
    const Measurement row = fullRow();
    const Json flat = measurementColumns(row), json = measurementJson(row);
    std::set<std::string> names;
    for (const auto& [key, value] : flat.items()) names.insert(key);
    CHECK(names.size() == flat.size());
    CHECK(flat.size() == json.size() - 2 + 3 * row.passes.size() + row.counters.size());
    CHECK(flat["voxel_mips_ms_spread"] == 0.5);
    CHECK(flat["invented_pass_ms_min"] == 2.0 / 7.0);
    CHECK(flat["invented_taps"] == 3.0);
    const Json settings = settingsToJson(Settings());
    for (const auto& [key, value] : settings.items()) CHECK(flat.contains(key));
}

TEST_CASE("a damaged row is refused by name", "[sweep]")
{
    const auto refused = [](const std::string& key, const Json& value) {
        Json json = measurementJson(fullRow());
        if (value == "gone")
            json.erase(key);
        else
            json[key] = value;
        try {
            measurementFromJson(json, "rows.jsonl:7");
        } catch (const InputError& error) {
            const std::string text = error.what();
            return text.rfind("rows.jsonl:7", 0) == 0 && text.find(key) != std::string::npos;
        }
        return false;
    };
    CHECK(refused("rmse", "gone"));
    CHECK(refused("rmse", "much"));
    CHECK(refused("kind", "guess"));
    CHECK(refused("bytes", -1));
    CHECK(refused("cone_count", 1000));
    CHECK(refused("estimator", "gone"));
    CHECK_THROWS_AS(measurementFromJson(Json::array(), "x"), InputError);
}

TEST_CASE("repeats are summarized by median, minimum and spread", "[sweep]")
{
    CHECK(summarize({}).median == 0.0);
    CHECK(summarize({4.0}).median == 4.0);
    CHECK(summarize({4.0}).spread == 0.0);
    const RepeatedTime odd = summarize({9.0, 1.0, 5.0}), even = summarize({8.0, 2.0, 4.0, 6.0});
    CHECK(odd.median == 5.0);
    CHECK(odd.min == 1.0);
    CHECK(odd.spread == Approx(8.0 / 5.0));
    CHECK(even.median == 5.0);
    CHECK(even.spread == Approx(6.0 / 5.0));
}

TEST_CASE("what is claimed takes the truth's noise out, and never goes below a quarter of it", "[sweep]")
{
    PictureError error;
    error.rmse = 0.5;
    error.noise = 0.3;
    CHECK(error.net() == Approx(0.4));
    error.rmse = 0.3;
    CHECK(error.net() == Approx(0.075));
    error.rmse = 0.2;
    CHECK(error.net() == Approx(0.075));
    error.noise = std::nan("");
    CHECK(std::isnan(error.net()));
}
