#include "core/scene/gltf_repair.h"

#include "core/scene/gltf_uri.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

namespace lrsm::gltf {
namespace {

using Json = nlohmann::ordered_json;

std::string plural(std::size_t count, const std::string& noun)
{
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// What a null in a list becomes.
enum class NullItem {
    kept,    ///< refused where the list is read: leaving it out would move what follows
    object,  ///< an empty one
    dropped
};

/// Members that are null go.
std::size_t removeNulls(Json& value, NullItem item)
{
    std::size_t removed = 0;
    if (value.is_object()) {
        for (auto member = value.begin(); member != value.end();) {
            const bool gone = member->is_null(), indices = member.key() == "children" || member.key() == "nodes";
            removed += gone ? 1 : member.key() == "extras" ? 0 : removeNulls(*member, indices ? NullItem::dropped : NullItem::kept);
            member = gone ? value.erase(member) : std::next(member);
        }
    } else if (value.is_array()) {
        for (std::size_t i = 0; i < value.size();) {
            const bool gone = value[i].is_null() && item != NullItem::kept;
            removed += gone ? 1 : removeNulls(value[i], NullItem::kept);
            if (gone && item == NullItem::object) value[i] = Json::object();
            if (gone && item == NullItem::dropped)
                value.erase(i);
            else
                ++i;
        }
    }
    return removed;
}

/// Of the whole file, whose own lists are of objects.
std::size_t removeNulls(Json& root)
{
    std::size_t removed = 0;
    for (auto member = root.begin(); member != root.end();) {
        const bool gone = member->is_null() && member.key() != "asset", names = member.key().starts_with("extensions");
        removed += gone ? 1 : member.key() == "extras" ? 0 : removeNulls(*member, names ? NullItem::kept : NullItem::object);
        member = gone ? root.erase(member) : std::next(member);
    }
    return removed;
}

/// JSON knows one kind of number, and some writers know float alone.
void wholeNumbers(Json& value)
{
    constexpr double kMaxExact = 9007199254740992.0;
    if (value.is_number_float()) {
        const double number = value.get<double>();
        if (number == std::floor(number) && number >= 0.0 && number <= kMaxExact && !std::signbit(number)) value = std::uint64_t(number);
    } else if (value.is_structured()) {
        for (Json& inner : value) wholeNumbers(inner);
    }
}

/// The objects of a top-level list; none where it is no list: the check says so.
template <class Visit>
void forEachObject(Json& root, const char* list, const Visit& visit)
{
    const auto found = root.find(list);
    if (found == root.end() || !found->is_array()) return;
    for (Json& item : *found)
        if (item.is_object()) visit(item);
}

std::size_t removeZeroStrides(Json& root)
{
    std::size_t removed = 0;
    forEachObject(root, "bufferViews", [&](Json& view) {
        if (const auto stride = view.find("byteStride"); stride != view.end() && *stride == 0) removed += view.erase("byteStride");
    });
    return removed;
}

std::size_t removeUnknownWraps(Json& root)
{
    constexpr auto kWraps = std::to_array<int>({33071, 33648, 10497});
    std::size_t removed = 0;
    forEachObject(root, "samplers", [&](Json& sampler) {
        for (const char* key : {"wrapS", "wrapT"}) {
            const auto wrap = sampler.find(key);
            if (wrap != sampler.end() && (!wrap->is_number_integer() || std::find(kWraps.begin(), kWraps.end(), wrap->get<std::int64_t>()) == kWraps.end()))
                removed += sampler.erase(key);
        }
        // What is no number names no filter, and bilinear is the default.
        for (const char* key : {"magFilter", "minFilter"})
            if (const auto filter = sampler.find(key); filter != sampler.end() && !filter->is_number_integer()) sampler.erase(key);
    });
    return removed;
}

struct LightRepairs {
    std::size_t ranges = 0, colors = 0;
};

LightRepairs repairLights(Json& root)
{
    LightRepairs repairs;
    const Json::json_pointer place("/extensions/KHR_lights_punctual");
    if (!root.contains(place) || !root.at(place).is_object()) return repairs;
    forEachObject(root.at(place), "lights", [&](Json& light) {
        if (const auto range = light.find("range"); range != light.end() && *range == 0) repairs.ranges += light.erase("range");
        if (const auto color = light.find("color"); color != light.end() && color->is_array() && color->size() == 4) {
            color->erase(3);
            ++repairs.colors;
        }
    });
    return repairs;
}

/// A rounding outside of [0, 1].
void clampRounding(Json& value, std::size_t& clamped)
{
    constexpr double kRounding = 1e-3;
    if (!value.is_number()) return;
    const double number = value.get<double>(), inside = std::clamp(number, 0.0, 1.0);
    if (number == inside || std::abs(number - inside) > kRounding) return;
    value = inside;
    ++clamped;
}

std::size_t clampFactors(Json& root)
{
    std::size_t clamped = 0;
    forEachObject(root, "materials", [&](Json& material) {
        const auto pbr = material.find("pbrMetallicRoughness");
        if (pbr == material.end() || !pbr->is_object()) return;
        for (const char* key : {"metallicFactor", "roughnessFactor"})
            if (const auto factor = pbr->find(key); factor != pbr->end()) clampRounding(*factor, clamped);
        if (const auto color = pbr->find("baseColorFactor"); color != pbr->end() && color->is_array())
            for (Json& channel : *color) clampRounding(channel, clamped);
    });
    return clamped;
}

void repairUris(Json& root, const std::string& file, std::vector<std::string>& notes)
{
    std::size_t base64 = 0;
    for (const char* list : {"buffers", "images"}) {
        forEachObject(root, list, [&](Json& item) {
            const auto uri = item.find("uri");
            if (uri == item.end() || !uri->is_string()) return;
            const std::string given = uri->get<std::string>();
            if (isDataUri(given)) {
                if (std::optional<std::string> plain = plainDataUri(given); plain && *plain != given) *uri = std::move(*plain), ++base64;
            } else if (const std::optional<std::string> name = otherFileName(given, file)) {
                *uri = encodeUri(*name);
                notes.push_back("file \"" + given + "\" read as \"" + *name + "\"");
            }
        });
    }
    if (base64 > 0) notes.push_back(plural(base64, "data URI") + " with odd base64 (white space, escapes or the alphabet of URLs) read as if plain");
}

}  // namespace

void repairJson(Json& json, const std::string& file, std::vector<std::string>& notes)
{
    if (!json.is_object()) return;
    const auto note = [&](std::size_t count, const char* what, const char* done) {
        if (count > 0) notes.push_back(plural(count, what) + " " + done);
    };
    note(removeNulls(json), "null value", "in the JSON taken as absent");
    wholeNumbers(json);
    note(removeZeroStrides(json), "byteStride", "of 0 taken as absent: elements lie close together");
    note(removeUnknownWraps(json), "unknown wrap mode", "taken as repeat");
    const LightRepairs lights = repairLights(json);
    note(lights.ranges, "light", "with a range of 0 taken as without limit");
    note(lights.colors, "light colour", "of four numbers: the fourth ignored");
    note(clampFactors(json), "material factor", "a rounding outside of [0, 1] clamped");
    repairUris(json, file, notes);
}

}  // namespace lrsm::gltf
