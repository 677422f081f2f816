#include "tests/accuracy/limits.h"

#include "core/base/errors.h"
#include "core/base/file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace lrsm::accuracy {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDigits = 4;

/// Up to kDigits significant digits, upwards: a limit as printed is never below what it was made from.
double roundedUp(double value)
{
    if (!(value > 0.0) || !std::isfinite(value)) return value;
    const double scale = std::pow(10.0, kDigits - 1 - std::floor(std::log10(value)));
    return std::ceil(value * scale) / scale;
}

template <class... Values>
std::string format(const char* text, Values... values)
{
    char line[240];
    std::snprintf(line, sizeof line, text, values...);
    return line;
}

void complainAbove(std::vector<std::string>& lines, const char* metric, double measured, double limit)
{
    if (!(measured <= limit))
        lines.push_back(format("%s: %.5g is above the limit %.4g", metric, measured, limit));
    else if (limit > kAllowed * measured)
        lines.push_back(format("%s: %.5g, and the limit %.4g is more than %g times that: make the limits anew", metric, measured, limit, kAllowed));
}

}  // namespace

Limits limitsFor(const PictureError& measured)
{
    const double energy = measured.energy;
    const double band = std::max(kLeastEnergyBand, (kMargin - 1.0) * std::min(std::abs(energy - 1.0), energy));
    return {energy - band, energy + band, roundedUp(kMargin * measured.net()), roundedUp(kMargin * measured.flip)};
}

std::vector<std::string> complaints(const PictureError& measured, const Limits& limits)
{
    std::vector<std::string> lines;
    if (!(measured.energy >= limits.energyMin && measured.energy <= limits.energyMax))
        lines.push_back(format("energy: %.5g is outside the limits %.4f .. %.4f", measured.energy, limits.energyMin, limits.energyMax));
    complainAbove(lines, "net RMSE / mean", measured.net(), limits.net);
    complainAbove(lines, "FLIP", measured.flip, limits.flip);
    if (measured.noise > kNoiseShare * measured.net())
        lines.push_back(format("noise of the truth: %.4g is above %g of the net RMSE / mean: make_truth.sh needs more samples", measured.noise, kNoiseShare));
    return lines;
}

LimitTable readLimits(const std::string& path)
{
    const std::vector<unsigned char> bytes = readFile(path);
    LimitTable table;
    try {
        for (const Json& row : Json::parse(bytes)) {
            const RowName name{row.at("scene"), row.at("preset"), row.at("layer")};
            const Limits limits{row.at("energy").at(0), row.at("energy").at(1), row.at("net"), row.at("flip")};
            if (!table.emplace(name, limits).second) throw InputError(path, "names " + name.scene + ", " + name.preset + ", " + name.layer + " twice");
        }
    } catch (const Json::exception& error) {
        throw InputError(path, error.what());
    }
    return table;
}

std::string rowText(const RowName& name, const Limits& limits)
{
    const auto quoted = [](const std::string& text) { return "\"" + text + "\","; };
    return format("{\"scene\": %-17s \"preset\": %-11s \"layer\": %-20s \"energy\": [%.4f, %.4f], \"net\": %.4g, \"flip\": %.4g}", quoted(name.scene).c_str(),
                  quoted(name.preset).c_str(), quoted(name.layer).c_str(), limits.energyMin, limits.energyMax, limits.net, limits.flip);
}

std::string tableText(const std::vector<std::pair<RowName, Limits>>& rows)
{
    std::string text;
    for (const auto& [name, limits] : rows) text += (text.empty() ? "[\n" : ",\n") + rowText(name, limits);
    return text + "\n]\n";
}

}  // namespace lrsm::accuracy
