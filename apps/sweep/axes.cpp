#include "apps/sweep/axes.h"

#include "core/base/file.h"
#include "core/base/json_reader.h"
#include "core/base/text.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <cmath>
#include <map>

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

/// Why the combination has no meaning; empty where it has one.
std::string refusalOf(const Settings& settings)
{
    try {
        validate(settings);
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

using Words = std::vector<std::string>;

/// Values worth a look, cheap to costly where that is known. Choices and flags list themselves.
Words valuesOf(const SettingInfo& info, const Settings& base)
{
    static const std::map<std::string, std::string> numbers = {{"voxel_resolution", "64 128 256 512 1024"},
                                                               {"voxel_cascades", "1 2 3"},
                                                               {"rsm_resolution", "128 256 512 1024 2048 4096"},
                                                               {"depth_layers", "1 2 3 4 6"},
                                                               {"normal_layers", "1 2 3 4"},
                                                               {"layer_overlap", "0 0.1 0.25"},
                                                               {"shadow_resolution", "1 2 4"},
                                                               {"depth_bias_texels", "0 0.75 2"},
                                                               {"pcf_width_texels", "1 2 4"},
                                                               {"shadow_cone_aperture_degrees", "1 2 5"},
                                                               {"cone_count", "1 2 3 4 6 8 9 12 16 24 32"},
                                                               {"aperture_scale", "1.4 1 0.7 0.5 0.35 0.25"},
                                                               {"filter_passes", "0 1 2 3"},
                                                               {"gather_divisor", "1 2 4"},
                                                               {"sets_per_pixel", "1 2 4"},
                                                               {"step", "1.5 1 0.75 0.5 0.4 0.25"},
                                                               {"start_voxels", "1 1.5 2 3 4 6"},
                                                               {"normal_offset_voxels", "0 0.5 1 1.5 2"},
                                                               {"min_diameter_voxels", "2 1 0.5"},
                                                               {"push", "0 0.5 1"},
                                                               {"transmittance_cutoff", "0.1 0.03 0.01 0"},
                                                               {"max_steps", "16 32 64 1024"},
                                                               {"density_k", "1 2 4"},
                                                               {"voxel_level_bias", "0 -1 -1.5 -2 -2.5 -3"},
                                                               {"emitter_delay_taps", "1.5 2.25 3 4.5"},
                                                               {"emitter_delay_voxels", "0 0.75 1.5"},
                                                               {"emitter_slant_cap", "1 0.5 0.25"},
                                                               {"v_radius_scale", "0.5 1 2"},
                                                               {"rsm_level_bias", "1 0.5 0 -0.5 -1"},
                                                               {"rsm_min_level", "2 1 0"},
                                                               {"rc_tile", "8 16 32 64"},
                                                               {"rc_resolution", "8 16 32"},
                                                               {"rc_radius", "0.75 1 1.5 2"},
                                                               {"rc_min_cosine", "-1 0.5 0.8"},
                                                               {"rc_min_pixels", "0 8"},
                                                               {"rc_max", "4096 16384 65536"},
                                                               {"vpl_clamp", "0.25 1 4"},
                                                               {"vpl_sigma", "0.1 0.25 0.5"},
                                                               {"pp_count", "8192 24000 65536 170000"},
                                                               {"pp_radius", "1 1.5 2 3"},
                                                               {"pp_grid", "6 12 24 32"},
                                                               {"pp_rays", "16 32 64 128 256"},
                                                               {"pp_lobe_rays", "0 16 64"},
                                                               {"pp_march_divisor", "8 4 2 1"},
                                                               {"pp_gather_divisor", "4 2 1"},
                                                               {"pp_filter_radius", "0 1 3 5"},
                                                               {"pp_range", "0 2 4 8 1000"},
                                                               {"ism_lights", "256 1024 4096 16384"},
                                                               {"ism_resolution", "32 64 128"},
                                                               {"ism_points", "2048 8192 32768"},
                                                               {"ism_bias", "0 0.005 0.01 0.02"},
                                                               {"gaussian_table_size", "64 256 1024 4096"},
                                                               {"specular_aperture_degrees", "5 10 20"}};
    if (const auto found = numbers.find(info.key); found != numbers.end()) return split(found->second, " ");
    if (info.allowed.find(" | ") != std::string::npos) return split(info.allowed, " | ");
    // A number that the list does not know: a quarter to four times the base's value, as far as its range goes.
    Words values;
    const auto json = settingsToJson(base).at(info.key);
    if (!json.is_number()) return values;  // a choice of one
    const double value = json.get<double>();
    for (const double factor : {0.25, 0.5, 2.0, 4.0}) {
        const std::string text = nlohmann::json(value == 0.0 ? factor : value * factor).dump();
        try {
            Settings changed = base;
            applySetting(changed, info.key + "=" + text);
            values.push_back(text);
        } catch (const InputError&) {
        }
    }
    return values;
}

/// What a value needs beside it to have a meaning or an effect.
Words companionsOf(const std::string& key, const std::string& value)
{
    static const std::string slab = "layer_overlap=0 layer_selection=touched estimator=slab", paper = "estimator=paper",
                             centre = "estimator=paper layer_selection=centre";
    static const std::map<std::string, std::string> byKey = {{"layer_overlap", centre},
                                                             {"outermost_decay", centre + " layer_overlap=0.1"},
                                                             {"shadow_resolution", "shadows=hard"},
                                                             {"depth_bias_texels", "shadows=hard"},
                                                             {"pcf_width_texels", "shadows=pcf"},
                                                             {"shadow_cone_aperture_degrees", "shadows=cone"},
                                                             {"vpl_clamp", "vpl_singularity=clamp"},
                                                             {"opacity", paper},
                                                             {"density_k", paper},
                                                             {"backface", paper},
                                                             {"v_radius_scale", paper},
                                                             {"transmittance", slab},
                                                             {"emitter_delay_taps", slab},
                                                             {"emitter_delay_voxels", slab},
                                                             {"emitter_slant_cap", slab},
                                                             {"gaussian_table_size", "gaussian=table"},
                                                             {"specular_aperture_degrees", "specular_aperture=fixed"}};
    if (key == "estimator" && value == "slab") return split(slab, " ");
    if (key == "layer_selection") return split(value == "centre" ? paper : "layer_overlap=0", " ");
    const auto found = byKey.find(key);
    return found == byKey.end() ? Words() : split(found->second, " ");
}

/// `base` with one value and its companions; the label names what differs from the base, the value itself first.
NamedSettings changed(const Settings& base, const std::string& assignment, const Words& companions)
{
    NamedSettings named{assignment, base};
    for (const std::string& companion : companions) {
        const Settings before = named.settings;
        applySetting(named.settings, companion);
        if (!(named.settings == before)) named.label += " " + companion;
    }
    applySetting(named.settings, assignment);
    return named;
}

/// What a choice of rotation or filter does shows against the other's; a cheap look at both.
void addPairs(std::vector<NamedSettings>& all, const Settings& base)
{
    for (const char* rotation : {"rotation=none", "rotation=azimuth", "rotation=strata"})
        for (const char* filter : {"irradiance_filter=false", "irradiance_filter=true"}) {
            NamedSettings named = changed(base, rotation, {filter});
            if (differences(base, named.settings).size() == 2) all.push_back(std::move(named));
        }
}

}  // namespace

Axis parseAxis(const std::string& text)
{
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) throw InputError("axis \"" + text + "\"", "must be key=v1,v2,...");
    const Axis axis{text.substr(0, equals), split(text.substr(equals + 1), ",")};
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
    for (NamedSettings& named : all) {
        const std::string refusal = refusalOf(named.settings);
        if (refusal.empty())
            meaningful.push_back(std::move(named));
        else if (refused)
            refused->push_back(named.label + ": " + refusal);
    }
    return meaningful;
}

std::vector<NamedSettings> oneAtATime(const Settings& base, std::vector<std::string>* refused)
{
    std::vector<NamedSettings> all;
    const auto isNew = [&](const Settings& settings) {
        return !(settings == base) && std::none_of(all.begin(), all.end(), [&](const NamedSettings& seen) { return seen.settings == settings; });
    };
    for (const SettingInfo& info : describeSettings()) {
        if (info.shorthand) continue;
        bool shownAlone = false;
        for (const std::string& value : valuesOf(info, base)) {
            const std::string assignment = info.key + "=" + value;
            const NamedSettings alone = changed(base, assignment, {}), together = changed(base, assignment, companionsOf(info.key, value));
            if (alone.settings == base) continue;
            const bool needsOthers = !(alone.settings == together.settings), meaningful = refusalOf(alone.settings).empty();
            // Where the base does not read the setting one value shows that; the others would be the same picture again.
            if (meaningful && isNew(alone.settings) && !(needsOthers && shownAlone)) {
                all.push_back(alone);
                shownAlone = true;
            }
            if (!needsOthers && meaningful) continue;
            const std::string refusal = refusalOf(together.settings);
            if (refusal.empty() && isNew(together.settings))
                all.push_back(together);
            else if (!refusal.empty() && refused)
                refused->push_back(together.label + ": " + refusal);
        }
    }
    addPairs(all, base);
    return all;
}

std::vector<Axis> searchAxes()
{
    std::vector<Axis> axes;
    for (const char* text :
         {"cone_count=1,2,3,4,6,9,12,16,24,32,48", "sets_per_pixel=1,2", "voxel_resolution=128,256,512,1024", "rsm_resolution=256,512,1024,2048",
          "depth_layers=1,2,3,4", "normal_layers=1,2,3", "step=1,0.75,0.5,0.4,0.3", "start_voxels=1.5,2,3,4", "emitter_delay_taps=1.5,2.25,3,4.5",
          "emitter_slant_cap=1,0.5,0.25", "rsm_level_bias=0,-0.5,-1", "aperture_scale=1,0.7,0.5,0.35", "opacity_axes=isotropic,directional",
          "voxelization=thin,conservative", "transmittance_cutoff=0.1,0.03,0.01", "voxel_level_bias=-1.5,-2,-2.5"})
        axes.push_back(parseAxis(text));
    return axes;
}

}  // namespace lrsm
