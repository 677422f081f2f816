#pragma once

#include "core/settings/settings.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The rows behind settings_table.h; only the settings library itself includes this.
namespace lrsm {

enum class SettingKind { flag, choice, whole, real };

/// Finite by construction: an infinite or NaN value is never in range.
struct SettingRange {
    float min = 0.0f, max = 1.0f;
    bool openMin = false, openMax = false;
    bool powerOfTwo = false;
};

/// A field as a double: flags are 0 or 1, choices their index; every int and float of Settings is exact in it.
struct SettingRow {
    std::string_view key, stage, unit, meaning, source;
    SettingKind kind = SettingKind::real;
    SettingRange range;
    std::vector<std::string_view> choices;  ///< in the order of the enumeration
    double (*get)(const Settings&) = nullptr;
    void (*set)(Settings&, double) = nullptr;
    bool shorthand = false;  ///< sets several fields; `get` reads the first
};

/// In the order of settings.h, the shorthands last.
std::span<const SettingRow> settingRows();

std::string allowedText(const SettingRow& row);
std::string valueText(const SettingRow& row, const Settings& settings);
bool inRange(const SettingRow& row, double value);
/// InputError with key, value and what is allowed.
void setFromText(const SettingRow& row, Settings& settings, const std::string& text);
/// InputError beginning with `place`, with the nearest key.
const SettingRow& findRow(const std::string& key, const std::string& place);

}  // namespace lrsm
