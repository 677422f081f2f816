#include "apps/check/candidate_map.h"

#include "core/base/file.h"
#include "core/base/json_reader.h"

#include <limits>

namespace lrsm {

namespace {

std::size_t channelIndex(char letter, const std::string& place)
{
    constexpr std::string_view kColor = "rgba", kVector = "xyzw";
    for (const std::string_view letters : {kColor, kVector})
        if (const std::size_t at = letters.find(letter); at != std::string_view::npos) return at;
    throw InputError(place, std::string("\"") + letter + "\" is none of r g b a x y z w");
}

std::vector<std::size_t> numbersFrom(const JsonReader& in)
{
    std::vector<std::size_t> numbers;
    for (const JsonReader& each : in.items()) numbers.push_back(each.count());
    return numbers;
}

std::vector<std::size_t> channelsFrom(const JsonReader& in)
{
    std::vector<std::size_t> channels;
    if (in.json().is_string())
        for (const char letter : in.text()) channels.push_back(channelIndex(letter, in.path()));
    else
        channels = numbersFrom(in);
    if (channels.empty()) in.fail("names no channel, as \"bgra\" or [2, 1, 0] do");
    return channels;
}

Transfer transferFrom(const JsonReader& in)
{
    if (in.text() == "linear") return Transfer::linear;
    if (in.text() != "srgb") in.fail("must be \"linear\" or \"srgb\"");
    return Transfer::srgb;
}

MapEntry entryFrom(const std::string& pattern, const JsonReader& in)
{
    MapEntry entry;
    entry.pattern = pattern;
    if (in.json().is_string()) {
        entry.file = in.text();
        return entry;
    }
    if (!in.json().is_object()) in.fail("must be a file's name or an object with \"file\"");
    for (const auto& [key, value] : in.members()) {
        if (key == "file")
            entry.file = value.text();
        else if (key == "layer")
            entry.layer = value.text();
        else if (key == "mip")
            entry.mip = static_cast<int>(value.whole(-1, std::numeric_limits<int>::max()));
        else if (key == "dtype")
            entry.dtype = std::string(nameOf(dtypeByName(value.text(), value.path())));
        else if (key == "transfer")
            entry.transfer = transferFrom(value);
        else if (key == "axes")
            entry.how.axes = value.texts();
        else if (key == "flip")
            entry.how.flip = value.texts();
        else if (key == "layers")
            entry.how.layers = numbersFrom(value);
        else if (key == "channels")
            entry.how.channels = channelsFrom(value);
        else if (key == "scale")
            entry.how.scale = value.number();
        else if (key == "offset")
            entry.how.offset = value.number();
        else if (key == "encoding")
            entry.how.encoding = encodingByName(value.text(), value.path());
        else
            value.fail("is no key of a map; they are file, layer, mip, dtype, transfer, axes, flip, layers, channels, scale, offset, encoding");
    }
    if (entry.file.empty()) in.fail("has no \"file\"");
    return entry;
}

}  // namespace

std::vector<MapEntry> readCandidateMap(const std::string& path)
{
    const JsonReader::Json json = parseJson(readFile(path), path);
    if (!json.is_object()) throw InputError(path, "must be an object: buffer names with the files that hold them");
    std::vector<MapEntry> map;
    for (const auto& [key, value] : JsonReader(json, path).members()) map.push_back(entryFrom(key, value));
    return map;
}

bool matches(const MapEntry& entry, const std::string& name)
{
    return entryFor({entry}, name).has_value();
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
