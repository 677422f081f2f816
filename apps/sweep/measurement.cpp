#include "apps/sweep/measurement.h"

#include "apps/common/describe.h"
#include "core/base/json_reader.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <cmath>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::pair<RowKind, const char*> kKinds[] = {
    {RowKind::preset, "preset"}, {RowKind::axis, "axis"}, {RowKind::search, "search"}, {RowKind::pathTracer, "path_tracer"}};

/// NaN for null.
double numberIn(const JsonReader& in)
{
    return in.isNull() ? std::numeric_limits<double>::quiet_NaN() : in.number();
}

void addTime(Json& json, const std::string& column, const RepeatedTime& time)
{
    json[column] = numberJson(time.median);
    json[column + "_min"] = numberJson(time.min);
    json[column + "_spread"] = numberJson(time.spread);
}

RepeatedTime readTime(const JsonReader& in, const std::string& column)
{
    return {numberIn(in[column]), numberIn(in[column + "_min"]), numberIn(in[column + "_spread"])};
}

RowKind kindNamed(const JsonReader& in)
{
    const std::string text = in.text();
    for (const auto& [kind, name] : kKinds)
        if (text == name) return kind;
    in.fail("must be preset, axis, search or path_tracer");
}

}  // namespace

const char* rowKindName(RowKind kind)
{
    for (const auto& [known, name] : kKinds)
        if (known == kind) return name;
    return "";
}

RepeatedTime summarize(std::vector<double> milliseconds)
{
    if (milliseconds.empty()) return {};
    std::sort(milliseconds.begin(), milliseconds.end());
    const std::size_t n = milliseconds.size();
    RepeatedTime time;
    time.median = n % 2 ? milliseconds[n / 2] : 0.5 * (milliseconds[n / 2 - 1] + milliseconds[n / 2]);
    time.min = milliseconds.front();
    time.spread = time.median > 0.0 ? (milliseconds.back() - milliseconds.front()) / time.median : 0.0;
    return time;
}

double PictureError::net() const
{
    if (std::isnan(rmse) || std::isnan(noise)) return std::numeric_limits<double>::quiet_NaN();
    // With the difference factored no square is lost where the two are close.
    const double claimed = std::sqrt(std::max(0.0, (rmse - noise) * (rmse + noise)));
    return std::max(claimed, 0.25 * noise);
}

namespace {

Json passesJson(const std::vector<PassTime>& passes)
{
    Json json = Json::object();
    for (const PassTime& pass : passes) {
        addTime(json[pass.family], "ms", pass.time);
        json[pass.family]["per_pixel"] = pass.perPixel;
    }
    return json;
}

}  // namespace

Json measurementJson(const Measurement& row)
{
    Json json = {{"scene", row.scene},
                 {"case", row.caseKey},
                 {"key", row.key},
                 {"label", row.label},
                 {"kind", rowKindName(row.kind)},
                 {"base", row.base},
                 {"spp", row.samples},
                 {"width", row.width},
                 {"height", row.height},
                 {"truth_spp", row.truthSamples},
                 {"energy", numberJson(row.error.energy)},
                 {"rmse", numberJson(row.error.rmse)},
                 {"net", numberJson(row.error.net())},
                 {"mae", numberJson(row.error.mae)},
                 {"flip", numberJson(row.error.flip)},
                 {"noise", numberJson(row.error.noise)}};
    addTime(json, "frame_ms", row.frame);
    json["frame_cpu_ms"] = numberJson(row.frameCpu);
    json["calibration_cpu_ms"] = numberJson(row.calibrationCpu);
    json["cost"] = numberJson(row.cost);
    json["passes"] = passesJson(row.passes);
    json["counters"] = countersJson(row.counters);
    json["rays"] = row.rays;
    json["bytes"] = row.bytes;
    json["gpu_bytes"] = row.gpuBytes;
    json["irradiance_sha256"] = row.irradianceSha256;
    const bool traced = row.kind == RowKind::pathTracer;
    const Json settings = settingsToJson(row.settings);
    for (const auto& [key, value] : settings.items()) json[key] = traced ? Json() : value;
    return json;
}

std::string passColumn(std::string family)
{
    std::replace(family.begin(), family.end(), ' ', '_');
    return family;
}

Json measurementColumns(const Measurement& row)
{
    Json flat = Json::object();
    const Json json = measurementJson(row);
    for (const auto& [key, value] : json.items()) {
        if (key == "passes") {
            for (const auto& [family, times] : value.items()) {
                for (const char* figure : {"ms", "ms_min", "ms_spread"}) flat[passColumn(family) + "_" + figure] = times[figure];
            }
        } else if (key == "counters") {
            flat.update(value);
        } else {
            flat[key] = value;
        }
    }
    return flat;
}

Measurement measurementFromJson(const Json& json, const std::string& place)
{
    const JsonReader in(json, place);
    Measurement row;
    row.scene = in["scene"].text();
    row.caseKey = in["case"].text();
    row.key = in["key"].text();
    row.label = in["label"].text();
    row.kind = kindNamed(in["kind"]);
    row.base = in["base"].text();
    row.samples = in["spp"].count();
    row.width = static_cast<int>(in["width"].count());
    row.height = static_cast<int>(in["height"].count());
    row.truthSamples = in["truth_spp"].count();
    // `net` follows from rmse and noise.
    row.error = {numberIn(in["energy"]), numberIn(in["rmse"]), numberIn(in["mae"]), numberIn(in["flip"]), numberIn(in["noise"])};
    row.frame = readTime(in, "frame_ms");
    row.frameCpu = numberIn(in["frame_cpu_ms"]);
    row.calibrationCpu = numberIn(in["calibration_cpu_ms"]);
    row.cost = numberIn(in["cost"]);
    for (const auto& [family, entry] : in["passes"].members()) row.passes.push_back({family, entry["per_pixel"].flag(), readTime(entry, "ms")});
    for (const auto& [name, entry] : in["counters"].members()) row.counters.push_back({name, numberIn(entry)});
    row.rays = in["rays"].count();
    row.bytes = in["bytes"].count();
    row.gpuBytes = in["gpu_bytes"].count();
    row.irradianceSha256 = in["irradiance_sha256"].text();
    if (row.kind == RowKind::pathTracer) return row;
    Json settings = settingsToJson(row.settings);
    for (auto& [key, value] : settings.items()) value = in[key].json();
    applySettingsJson(row.settings, settings, place);
    return row;
}

}  // namespace lrsm
