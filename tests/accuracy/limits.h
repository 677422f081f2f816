#pragma once

#include "apps/sweep/measurement.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

/// How far from the truth each layer of each preset may be: limits.json, and what it means.
namespace lrsm::accuracy {

struct RowName {
    std::string scene, preset, layer;
    auto operator<=>(const RowName&) const = default;
};

/// A figure on its limit holds; NaN does not.
struct Limits {
    double energyMin = 0.0, energyMax = 0.0;  ///< of the picture's sum over the truth's: both ways, since light too much is as wrong as light too little
    double net = 0.0;                         ///< RMSE / mean without the truth's noise
    double flip = 0.0;
};

/// A limit is this factor above what was measured; where it is kAllowed times what is measured now, it no longer guards and must be made anew.
inline constexpr double kMargin = 1.07, kAllowed = 1.15;
/// The band of the energy is (kMargin - 1) of its distance from right, or of itself where nearly all light is lost; but this at least.
inline constexpr double kLeastEnergyBand = 0.001;
/// The truth's own noise may be this share of the error that it tells.
inline constexpr double kNoiseShare = 0.25;

Limits limitsFor(const PictureError& measured);

/// One line for each limit that is broken, too loose, or means nothing for noise: metric, measured, limit.
std::vector<std::string> complaints(const PictureError& measured, const Limits& limits);

using LimitTable = std::map<RowName, Limits>;
/// Throws InputError for a file that is no such table or names a row twice.
LimitTable readLimits(const std::string& path);

/// A row as a line of limits.json.
std::string rowText(const RowName& name, const Limits& limits);
/// The whole file.
std::string tableText(const std::vector<std::pair<RowName, Limits>>& rows);

}  // namespace lrsm::accuracy
