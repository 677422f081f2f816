#include "apps/sweep/axes.h"

#include "core/base/file.h"
#include "core/base/json_reader.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <cmath>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

/// Of one JSON value, as --set takes it.
std::string textOf(const Json& value, const std::string& place)
{
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean() || value.is_number_integer()) return value.dump();
    if (!value.is_number()) throw InputError(place, "values must be numbers, strings, true or false");
    const double number = value.get<double>();
    return number == std::floor(number) && std::abs(number) < 1e9 ? std::to_string(static_cast<long long>(number)) : value.dump();
}

void addPart(std::string& label, const std::string& part)
{
    label += (label.empty() ? "" : " ") + part;
}

/// False, and the reason is kept, where the combination has no meaning.
bool isMeaningful(const NamedSettings& named, std::vector<std::string>* refused)
{
    try {
        validate(named.settings);
        return true;
    } catch (const InputError& error) {
        if (refused) refused->push_back(named.label + ": " + error.what());
        return false;
    }
}

}  // namespace

Axis parseAxis(const std::string& text)
{
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) throw InputError("axis \"" + text + "\"", "must be key=v1,v2,...");
    Axis axis{text.substr(0, equals), {}};
    for (std::size_t begin = equals + 1; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        axis.values.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    for (const std::string& value : axis.values) {
        Settings settings;
        applySetting(settings, axis.key + "=" + value);
    }
    return axis;
}

std::vector<Axis> readAxes(const std::string& path)
{
    const Json json = parseJson(readFile(path), path, "write {\"cone_count\": [4, 6, 12], ...}");
    if (!json.is_object() || json.empty()) throw InputError(path, "must be an object of lists, as {\"cone_count\": [4, 6, 12]}");
    std::vector<Axis> axes;
    for (const auto& [key, values] : json.items()) {
        if (!values.is_array() || values.empty()) throw InputError(path + ": " + key, "must be a list of values, as [4, 6, 12]");
        Axis axis{key, {}};
        for (const Json& value : values) {
            axis.values.push_back(textOf(value, path + ": " + key));
            Settings settings;
            try {
                applySetting(settings, key + "=" + axis.values.back());
            } catch (const InputError& error) {
                throw InputError(path, error.what());
            }
        }
        axes.push_back(std::move(axis));
    }
    return axes;
}

std::vector<NamedSettings> combine(const Settings& base, const std::vector<Axis>& axes, std::vector<std::string>* refused)
{
    std::vector<NamedSettings> all{{"", base}};
    for (const Axis& axis : axes) {
        std::vector<NamedSettings> longer;
        for (const NamedSettings& named : all)
            for (const std::string& value : axis.values) {
                longer.push_back(named);
                applySetting(longer.back().settings, axis.key + "=" + value);
                addPart(longer.back().label, axis.key + "=" + value);
            }
        all = std::move(longer);
    }
    std::vector<NamedSettings> meaningful;
    for (NamedSettings& named : all)
        if (isMeaningful(named, refused)) meaningful.push_back(std::move(named));
    return meaningful;
}

std::vector<Axis> searchAxes()
{
    std::vector<Axis> axes;
    for (const char* text :
         {"cone_count=1,2,3,4,6,9,12,16,24,32,48", "sets_per_pixel=1,2", "voxel_resolution=128,256,512,1024", "rsm_resolution=256,512,1024,2048",
          "depth_layers=1,2,3,4", "normal_layers=1,2,3", "step=1,0.75,0.5,0.35", "start_voxels=1.5,2,3,4", "emitter_delay_taps=1.5,2,2.5,3.5",
          "emitter_slant_cap=1,0.5,0.25", "rsm_level_bias=0,-0.5,-1", "aperture_scale=1,0.7,0.5,0.35", "opacity_axes=isotropic,directional",
          "voxelization=thin,conservative", "transmittance_cutoff=0.1,0.03,0.01", "voxel_level_bias=-1.5,-2,-2.5"})
        axes.push_back(parseAxis(text));
    return axes;
}

}  // namespace lrsm
