#include "core/settings/settings_table.h"

#include "core/base/errors.h"
#include "core/base/text.h"
#include "core/settings/settings_rows.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

namespace lrsm {

namespace {

/// Shortest text that reads back to the same float.
std::string floatText(float value)
{
    char buffer[64];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return std::string(buffer, end);
}

template <class Number>
bool parseWhole(const std::string& text, Number& value)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

[[noreturn]] void refuse(const SettingRow& row, const std::string& value)
{
    throw InputError("setting " + std::string(row.key) + "=" + value, "must be " + allowedText(row));
}

}  // namespace

std::string allowedText(const SettingRow& row)
{
    switch (row.kind) {
    case SettingKind::flag: return "true | false";
    case SettingKind::choice: return joined(row.choices, {}, " | ");
    case SettingKind::whole:
        return std::to_string(int(row.range.min)) + " .. " + std::to_string(int(row.range.max)) + (row.range.powerOfTwo ? ", power of two" : "");
    case SettingKind::real: break;
    }
    return (row.range.openMin ? "(" : "[") + floatText(row.range.min) + ", " + floatText(row.range.max) + (row.range.openMax ? ")" : "]");
}

std::string valueText(const SettingRow& row, const Settings& settings)
{
    const double value = row.get(settings);
    switch (row.kind) {
    case SettingKind::flag: return value != 0.0 ? "true" : "false";
    case SettingKind::choice: {
        const auto index = static_cast<std::size_t>(value);
        return index < row.choices.size() ? std::string(row.choices[index]) : "(invalid)";
    }
    case SettingKind::whole: return std::to_string(static_cast<long long>(value));
    case SettingKind::real: break;
    }
    return floatText(static_cast<float>(value));
}

bool inRange(const SettingRow& row, double value)
{
    // Every comparison with NaN is false, so NaN is refused by the first.
    const SettingRange& range = row.range;
    if (!(value >= double(range.min) && value <= double(range.max))) return false;
    if ((range.openMin && value == double(range.min)) || (range.openMax && value == double(range.max))) return false;
    return !range.powerOfTwo || std::has_single_bit(static_cast<unsigned>(value));
}

void setFromText(const SettingRow& row, Settings& settings, const std::string& text)
{
    switch (row.kind) {
    case SettingKind::flag:
        if (text != "true" && text != "false") refuse(row, text);
        return row.set(settings, text == "true");
    case SettingKind::choice: {
        const auto found = std::find(row.choices.begin(), row.choices.end(), text);
        if (found == row.choices.end()) refuse(row, text);
        return row.set(settings, double(found - row.choices.begin()));
    }
    case SettingKind::whole: {
        int value = 0;
        if (!parseWhole(text, value) || !inRange(row, value)) refuse(row, text);
        return row.set(settings, value);
    }
    case SettingKind::real: {
        float value = 0.0f;
        if (!parseWhole(text, value) || !inRange(row, double(value))) refuse(row, text);
        return row.set(settings, double(value));
    }
    }
}

const SettingRow& findRow(const std::string& key, const std::string& place)
{
    for (const SettingRow& row : settingRows())
        if (row.key == key) return row;

    const SettingRow* nearest = nullptr;
    std::size_t nearestDistance = std::max<std::size_t>(3, std::min<std::size_t>(key.size(), 64) / 2);
    for (const SettingRow& row : settingRows()) {
        if (key.size() > 64) break;  // no misspelling
        // An abbreviation ("filter" for irradiance_filter) is as near as a misspelling.
        const bool part = key.size() >= 4 && row.key.find(key) != std::string_view::npos;
        const std::size_t distance = part ? 1 : editDistance(key, row.key);
        if (distance < nearestDistance) nearest = &row, nearestDistance = distance;
    }
    throw InputError(
        place, "there is no setting \"" + key + "\"" + (nearest ? "; did you mean " + std::string(nearest->key) + "?" : "") + " (`lrsm settings` lists them)");
}

void applySetting(Settings& settings, const std::string& assignment)
{
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) throw InputError("setting \"" + assignment + "\"", "must be written key=value");
    const std::string key = assignment.substr(0, equals);
    setFromText(findRow(key, "setting " + assignment), settings, assignment.substr(equals + 1));
}

namespace {

void checkRanges(const Settings& settings)
{
    for (const SettingRow& row : settingRows())
        if (!row.shorthand && !inRange(row, row.get(settings))) refuse(row, valueText(row, settings));
}

}  // namespace

void validate(const Settings& settings)
{
    checkRanges(settings);

    const LayerSettings& layers = settings.layers;
    const ConeSettings& cones = settings.cones;
    if (cones.gather.layerSelection == LayerSelection::touched && layers.overlap != 0.0f)
        throw InputError("settings layer_selection=touched, layer_overlap=" + floatText(layers.overlap),
                         "every touched layer is summed, so overlapping layers would count light twice; set layer_overlap=0 or "
                         "layer_selection=centre");
    if (cones.march.estimator == Estimator::slab && cones.gather.layerSelection != LayerSelection::touched)
        throw InputError("settings estimator=slab, layer_selection=centre",
                         "the slab estimator sums a partition of the layers; set layer_selection=touched and layer_overlap=0, or "
                         "estimator=paper");

    if (settings.voxel.cascades == 1) return;
    const std::string place = "settings voxel_cascades=" + std::to_string(settings.voxel.cascades);
    if (settings.method == Method::vct || settings.method == Method::caches ||
        (settings.method == Method::lrsm && cones.march.visibility == Visibility::voxelRays))
        throw InputError(place, "cones of method=lrsm alone march through several grids; set voxel_cascades=1, or method=lrsm with visibility=cones");
    if (settings.voxel.resolution < kLeastCascadeResolution)
        throw InputError(place + ", voxel_resolution=" + std::to_string(settings.voxel.resolution),
                         "grids of so few voxels cannot lie in each other; set voxel_resolution=" + std::to_string(kLeastCascadeResolution) + " or more");
}

std::vector<SettingInfo> describeSettings()
{
    const Settings balanced = preset("balanced");
    std::vector<SettingInfo> infos;
    for (const SettingRow& row : settingRows())
        infos.push_back({std::string(row.key), std::string(row.stage), allowedText(row), std::string(row.unit), std::string(row.meaning),
                         std::string(row.source), valueText(row, balanced), row.shorthand});
    return infos;
}

std::vector<SettingDifference> differences(const Settings& a, const Settings& b)
{
    std::vector<SettingDifference> found;
    for (const SettingRow& row : settingRows())
        if (!row.shorthand && row.get(a) != row.get(b)) found.push_back({std::string(row.key), valueText(row, a), valueText(row, b)});
    return found;
}

}  // namespace lrsm
