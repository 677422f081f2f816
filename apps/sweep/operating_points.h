#pragma once

#include "apps/sweep/axes.h"

#include <string_view>
#include <vector>

namespace lrsm {

/// `base` with "key=value key=value" laid over it, as --set would; validated. Throws InputError.
Settings settingsFromText(Settings base, std::string_view assignments);

/// Fourteen settings along the front, by rising cost: what `lrsm tune` chooses among. The list is operating_points.cpp's table alone.
std::vector<NamedSettings> operatingPoints();

}  // namespace lrsm
