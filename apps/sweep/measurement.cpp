#include "apps/sweep/measurement.h"

#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::pair<RowKind, const char*> kKinds[] = {
    {RowKind::preset, "preset"}, {RowKind::axis, "axis"}, {RowKind::search, "search"}, {RowKind::pathTracer, "path_tracer"}};

/// JSON has no infinity and no NaN.
Json numberJson(double value)
{
    return std::isfinite(value) ? Json(value) : Json();
}

/// Reads entries of one row, naming what is wrong.
class RowReader {
  public:
    RowReader(const Json& json, const std::string& place) : json_(json), place_(place)
    {
        if (!json.is_object()) throw InputError(place, "must be a JSON object, a row of a sweep");
    }

    const Json& entry(const std::string& name) const
    {
        const auto found = json_.find(name);
        if (found == json_.end()) throw InputError(place_, "has no entry \"" + name + "\"; is it a row of `lrsm sweep`?");
        return *found;
    }

    /// NaN for null.
    double number(const std::string& name) const
    {
        const Json& value = entry(name);
        if (value.is_null()) return std::numeric_limits<double>::quiet_NaN();
        if (!value.is_number()) refuse(name, "a number");
        return value.get<double>();
    }

    std::uint64_t count(const std::string& name) const
    {
        const Json& value = entry(name);
        if (!value.is_number_integer() || (!value.is_number_unsigned() && value.get<std::int64_t>() < 0)) refuse(name, "a whole number, not negative");
        return value.get<std::uint64_t>();
    }

    const Json& object(const std::string& name) const
    {
        if (!entry(name).is_object()) refuse(name, "an object");
        return entry(name);
    }
    std::string text(const std::string& name) const
    {
        const Json& value = entry(name);
        if (!value.is_string()) refuse(name, "a string");
        return value.get<std::string>();
    }

    [[noreturn]] void refuse(const std::string& name, const std::string& wanted) const { throw InputError(place_ + ": " + name, "must be " + wanted); }

  private:
    const Json& json_;
    const std::string& place_;
};

void addTime(Json& json, const std::string& column, const RepeatedTime& time)
{
    json[column] = numberJson(time.median);
    json[column + "_min"] = numberJson(time.min);
    json[column + "_spread"] = numberJson(time.spread);
}

RepeatedTime readTime(const RowReader& reader, const std::string& column)
{
    return {reader.number(column), reader.number(column + "_min"), reader.number(column + "_spread")};
}

RowKind kindNamed(const RowReader& reader)
{
    const std::string text = reader.text("kind");
    for (const auto& [kind, name] : kKinds)
        if (text == name) return kind;
    reader.refuse("kind", "preset, axis, search or path_tracer");
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

Json timeJson(const RepeatedTime& time)
{
    return {{"ms", numberJson(time.median)}, {"ms_min", numberJson(time.min)}, {"ms_spread", numberJson(time.spread)}};
}

Json passesJson(const std::vector<PassTime>& passes)
{
    Json json = Json::object();
    for (const PassTime& pass : passes) {
        json[pass.family] = timeJson(pass.time);
        json[pass.family]["per_pixel"] = pass.perPixel;
    }
    return json;
}

Json countersJson(const Counters& counters)
{
    Json json = Json::object();
    for (const Counter& counter : counters) json[counter.name] = numberJson(counter.value);
    return json;
}

std::vector<PassTime> readPasses(const Json& json, const std::string& place)
{
    std::vector<PassTime> passes;
    for (const auto& [family, entry] : json.items()) {
        const std::string where = place + ": passes: " + family;
        const RowReader reader(entry, where);
        const Json& perPixel = reader.entry("per_pixel");
        if (!perPixel.is_boolean()) reader.refuse("per_pixel", "true or false");
        passes.push_back({family, perPixel.get<bool>(), {reader.number("ms"), reader.number("ms_min"), reader.number("ms_spread")}});
    }
    return passes;
}

Counters readCounters(const Json& json, const std::string& place)
{
    Counters counters;
    const std::string where = place + ": counters";
    const RowReader reader(json, where);
    for (const auto& [name, unused] : json.items()) counters.push_back({name, reader.number(name)});
    return counters;
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
    json["instructions"] = row.instructions ? Json(*row.instructions) : Json();
    json["bytes"] = row.bytes;
    json["gpu_bytes"] = row.gpuBytes;
    json["irradiance_sha256"] = row.irradianceSha256;
    const bool traced = row.kind == RowKind::pathTracer;
    const Json settings = settingsToJson(row.settings);
    for (const auto& [key, value] : settings.items()) json[key] = traced ? Json() : value;
    return json;
}

Json measurementColumns(const Measurement& row)
{
    Json flat = Json::object();
    const Json json = measurementJson(row);
    for (const auto& [key, value] : json.items()) {
        if (key == "passes") {
            for (const auto& [family, times] : value.items()) {
                std::string column = family + "_";
                std::replace(column.begin(), column.end(), ' ', '_');
                for (const char* figure : {"ms", "ms_min", "ms_spread"}) flat[column + figure] = times[figure];
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
    const RowReader reader(json, place);
    Measurement row;
    row.scene = reader.text("scene");
    row.caseKey = reader.text("case");
    row.key = reader.text("key");
    row.label = reader.text("label");
    row.kind = kindNamed(reader);
    row.base = reader.text("base");
    row.samples = reader.count("spp");
    row.width = static_cast<int>(reader.count("width"));
    row.height = static_cast<int>(reader.count("height"));
    row.truthSamples = reader.count("truth_spp");
    // `net` follows from rmse and noise.
    row.error = {reader.number("energy"), reader.number("rmse"), reader.number("mae"), reader.number("flip"), reader.number("noise")};
    row.frame = readTime(reader, "frame_ms");
    row.frameCpu = reader.number("frame_cpu_ms");
    row.calibrationCpu = reader.number("calibration_cpu_ms");
    row.cost = reader.number("cost");
    row.passes = readPasses(reader.object("passes"), place);
    row.counters = readCounters(reader.object("counters"), place);
    row.rays = reader.count("rays");
    if (!reader.entry("instructions").is_null()) row.instructions = reader.count("instructions");
    row.bytes = reader.count("bytes");
    row.gpuBytes = reader.count("gpu_bytes");
    row.irradianceSha256 = reader.text("irradiance_sha256");
    if (row.kind == RowKind::pathTracer) return row;
    Json settings = settingsToJson(row.settings);
    for (auto& [key, value] : settings.items()) value = reader.entry(key);
    applySettingsJson(row.settings, settings, place);
    return row;
}

}  // namespace lrsm
