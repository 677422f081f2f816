#pragma once

#include "core/settings/settings.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

/// One table of every field of settings.h: it feeds --set, JSON files, frame.json, the range checks and docs/settings.md,
/// so that the five cannot disagree.
namespace lrsm {

/// One row, as text for people.
struct SettingInfo {
    std::string key;           ///< as in --set key=value and in JSON
    std::string stage;         ///< "voxel", "rsm", "layers", "direct", "cones", "force"; "several" for a shorthand
    std::string allowed;       ///< "1 .. 16", "(0, 2]", "mean | coverage | max", "true | false"
    std::string unit;          ///< may be empty
    std::string meaning;       ///< one line
    std::string source;        ///< "paper Sec. 4.3", "ours", ...
    std::string defaultValue;  ///< in `balanced`
    bool shorthand = false;    ///< sets several fields at once; not written to JSON
};
std::vector<SettingInfo> describeSettings();

/// Applies "key=value". InputError names key, value and what is allowed, and the nearest key for a misspelt one. A shorthand
/// (`storage`, `half_rounding`) sets each of its fields. Only this field is checked: call `validate` once all are applied.
void applySetting(Settings& settings, const std::string& assignment);

/// Every field, flat, in the table's order; floats in the fewest digits that read back to the same bits.
nlohmann::ordered_json settingsToJson(const Settings& settings);

/// Lays an object of keys over `settings`, in the object's order. Unknown keys, wrong types and values out of range are InputErrors
/// that begin with `place`. An object with a "settings" object inside (frame.json) stands for that object.
void applySettingsJson(Settings& settings, const nlohmann::ordered_json& object, const std::string& place);

/// The same for a file; partial files are layered over what `settings` holds.
void applySettingsFile(Settings& settings, const std::string& path);

/// Throws InputError on any field out of range (NaN included) and on combinations that have no meaning: the message says which.
void validate(const Settings& settings);

struct SettingDifference {
    std::string key, a, b;
};
std::vector<SettingDifference> differences(const Settings& a, const Settings& b);

struct PresetInfo {
    std::string name, summary;
};
/// `literal`, `fast`, `balanced` (the default), `fine`, `accurate`.
std::vector<PresetInfo> presetInfos();
std::vector<std::string> presetNames();
/// InputError names the presets for an unknown one.
Settings preset(const std::string& name);

/// docs/settings.md: the table and what each preset changes.
std::string settingsMarkdown();

}  // namespace lrsm
