#pragma once

#include "core/settings/settings.h"

#include <string>
#include <vector>

/// Which settings a sweep visits.
namespace lrsm {

/// Values of one setting, from cheap to costly where that is known.
struct Axis {
    std::string key;
    std::vector<std::string> values;  ///< as in --set
};

/// "key=v1,v2,..."; throws InputError for an unknown key, a value out of range or an empty list.
Axis parseAxis(const std::string& text);
/// A JSON object of key: [values], for --axes FILE.
std::vector<Axis> readAxes(const std::string& path);

/// A setting to visit and what to call it.
struct NamedSettings {
    std::string label;  ///< the preset's name, or "key=value key=value"
    Settings settings;
};

/// Every combination of the axes' values over `base`; combinations that `validate` refuses are left out and named in `refused`.
std::vector<NamedSettings> combine(const Settings& base, const std::vector<Axis>& axes, std::vector<std::string>* refused = nullptr);

/// Values around `base` for every setting of the program, those that the base cannot feel included (the sweep shows that they are equal in
/// every bit). Settings that only make sense together are changed together.
std::vector<NamedSettings> oneAtATime(const Settings& base, std::vector<std::string>* refused = nullptr);

/// The axes of the front search, each ordered from cheap and coarse to costly and fine.
std::vector<Axis> searchAxes();

}  // namespace lrsm
