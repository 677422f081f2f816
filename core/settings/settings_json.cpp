#include "core/settings/settings_table.h"

#include "core/base/file.h"
#include "core/base/json_reader.h"
#include "core/settings/settings_rows.h"

#include <charconv>
#include <cmath>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

Json valueJson(const SettingRow& row, const Settings& settings)
{
    const double value = row.get(settings);
    switch (row.kind) {
    case SettingKind::flag: return value != 0.0;
    case SettingKind::whole: return static_cast<int>(value);
    case SettingKind::choice: return valueText(row, settings);
    case SettingKind::real: break;
    }
    // As a double, 0.1f would print as 0.10000000149011612; the double nearest to its shortest text prints as 0.1.
    double shortest = 0.0;
    const std::string text = valueText(row, settings);
    std::from_chars(text.data(), text.data() + text.size(), shortest);
    return static_cast<double>(static_cast<float>(shortest)) == value ? shortest : value;
}

/// What the value would be on the command line: one set of range checks for both.
std::string textOf(const Json& value)
{
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) {
        const double number = value.get<double>();
        if (number == std::floor(number) && std::abs(number) < 1e9) return std::to_string(static_cast<long long>(number));
    }
    return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool matchesKind(const SettingRow& row, const Json& value)
{
    switch (row.kind) {
    case SettingKind::flag: return value.is_boolean();
    case SettingKind::choice: return value.is_string();
    case SettingKind::whole:
    case SettingKind::real: break;
    }
    return value.is_number();
}

const char* kindName(SettingKind kind)
{
    return kind == SettingKind::flag ? "true or false" : kind == SettingKind::choice ? "a string" : "a number";
}

}  // namespace

Json settingsToJson(const Settings& settings)
{
    Json object = Json::object();
    for (const SettingRow& row : settingRows())
        if (!row.shorthand) object[std::string(row.key)] = valueJson(row, settings);
    return object;
}

void applySettingsJson(Settings& settings, const Json& object, const std::string& place)
{
    if (!object.is_object()) throw InputError(place, "must be a JSON object of settings, as {\"cone_count\": 6}");
    if (const auto inner = object.find("settings"); inner != object.end() && inner->is_object())
        return applySettingsJson(settings, *inner, place + ": settings");
    for (const auto& [key, value] : object.items()) {
        const SettingRow& row = findRow(key, place);
        if (!matchesKind(row, value)) throw InputError(place + ": " + key, std::string("must be ") + kindName(row.kind));
        try {
            setFromText(row, settings, textOf(value));
        } catch (const InputError& error) {
            throw InputError(place, error.what());
        }
    }
}

void applySettingsFile(Settings& settings, const std::string& path)
{
    applySettingsJson(settings, parseJson(readFile(path), path), path);
}

}  // namespace lrsm
