#include "apps/check/candidate_map.h"

#include "core/base/errors.h"
#include "core/base/file.h"

#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using MapJson = nlohmann::ordered_json;

std::size_t channelIndex(char letter, const std::string& place)
{
    constexpr std::string_view kColor = "rgba", kVector = "xyzw";
    for (const std::string_view letters : {kColor, kVector})
        if (const std::size_t at = letters.find(letter); at != std::string_view::npos) return at;
    throw InputError(place, std::string("\"") + letter + "\" is none of r g b a x y z w");
}

std::vector<std::size_t> channelsFrom(const MapJson& json, const std::string& place)
{
    std::vector<std::size_t> channels;
    if (json.is_string())
        for (const char letter : json.get<std::string>()) channels.push_back(channelIndex(letter, place));
    else
        for (const MapJson& each : json) {
            if (!each.is_number_unsigned()) throw InputError(place, "must be letters, as \"bgra\", or numbers from 0 on");
            channels.push_back(each.get<std::size_t>());
        }
    if (channels.empty()) throw InputError(place, "names no channel");
    return channels;
}

template <class T>
T valueFrom(const MapJson& json, const char* what, const std::string& place)
{
    try {
        return json.get<T>();
    } catch (const MapJson::exception&) {
        throw InputError(place, std::string("must be ") + what);
    }
}

std::vector<std::size_t> layersFrom(const MapJson& json, const std::string& place)
{
    std::vector<std::size_t> layers;
    for (const MapJson& each : json) {
        if (!each.is_number_unsigned()) throw InputError(place, "must be a list of numbers from 0 on");
        layers.push_back(each.get<std::size_t>());
    }
    return layers;
}

MapEntry entryFrom(const std::string& pattern, const MapJson& json, const std::string& place)
{
    MapEntry entry;
    entry.pattern = pattern;
    if (json.is_string()) {
        entry.file = json.get<std::string>();
        return entry;
    }
    if (!json.is_object()) throw InputError(place, "must be a file's name or an object with \"file\"");
    for (const auto& [key, value] : json.items()) {
        const std::string at = place + "." + key;
        if (key == "file")
            entry.file = valueFrom<std::string>(value, "a file's name", at);
        else if (key == "layer")
            entry.layer = valueFrom<std::string>(value, "the name of an EXR's layer", at);
        else if (key == "mip")
            entry.mip = valueFrom<int>(value, "a mip's number", at);
        else if (key == "dtype")
            entry.dtype = std::string(nameOf(dtypeByName(valueFrom<std::string>(value, "an element type", at), at)));
        else if (key == "axes")
            entry.how.axes = valueFrom<std::vector<std::string>>(value, "a list of axes' names", at);
        else if (key == "flip")
            entry.how.flip = valueFrom<std::vector<std::string>>(value, "a list of axes' names", at);
        else if (key == "layers")
            entry.how.layers = layersFrom(value, at);
        else if (key == "channels")
            entry.how.channels = channelsFrom(value, at);
        else if (key == "scale")
            entry.how.scale = valueFrom<double>(value, "a number", at);
        else if (key == "offset")
            entry.how.offset = valueFrom<double>(value, "a number", at);
        else if (key == "encoding")
            entry.how.encoding = encodingByName(valueFrom<std::string>(value, "number, unorm or bits", at), at);
        else
            throw InputError(at, "is no key of a map; they are file, layer, mip, dtype, axes, flip, layers, channels, scale, offset, encoding");
    }
    if (entry.file.empty()) throw InputError(place, "has no \"file\"");
    return entry;
}

}  // namespace

std::vector<MapEntry> readCandidateMap(const std::string& path)
{
    MapJson json;
    try {
        json = MapJson::parse(readFile(path));
    } catch (const MapJson::exception& error) {
        const std::string why = error.what();
        const std::size_t at = why.find("line ");
        throw InputError(path, "is no JSON" + (at == std::string::npos ? std::string() : ": " + why.substr(at)));
    }
    if (!json.is_object()) throw InputError(path, "must be an object: buffer names with the files that hold them");
    std::vector<MapEntry> map;
    for (const auto& [key, value] : json.items()) map.push_back(entryFrom(key, value, path + ": " + key));
    return map;
}

std::optional<MapEntry> entryFor(const std::vector<MapEntry>& map, const std::string& name)
{
    for (const MapEntry& entry : map) {
        const std::size_t star = entry.pattern.find('*');
        if (star == std::string::npos) {
            if (entry.pattern == name) return entry;
            continue;
        }
        const std::string before = entry.pattern.substr(0, star), after = entry.pattern.substr(star + 1);
        if (name.size() < before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after)) continue;
        MapEntry filled = entry;
        const std::string matched = name.substr(before.size(), name.size() - before.size() - after.size());
        if (const std::size_t at = filled.file.find('*'); at != std::string::npos) filled.file.replace(at, 1, matched);
        if (const std::size_t at = filled.layer.find('*'); at != std::string::npos) filled.layer.replace(at, 1, matched);
        return filled;
    }
    return {};
}

}  // namespace lrsm
