#include "core/scene/view_keys.h"

#include <algorithm>

namespace lrsm {
namespace {

using Json = JsonReader::Json;

constexpr double kLatestSecond = 1e6;  // float seconds still tell a tenth of one apart

/// A number or three, as numbers.
std::vector<double> valuesOf(const JsonReader& in)
{
    if (!in.json().is_array()) return {in.number()};
    in.vector();  // refuses what is none
    std::vector<double> values;
    for (const JsonReader& item : in.items()) values.push_back(item.number());
    return values;
}

struct Key {
    double time = 0.0;
    std::vector<double> values;
};

/// The keys that give `name`.
std::vector<Key> keysOf(const JsonReader& thing, std::string_view name)
{
    std::vector<Key> keys;
    for (const JsonReader& key : thing["keys"].items()) {
        if (!key.has(std::string(name))) continue;
        const JsonReader given = key[std::string(name)];
        keys.push_back({key["time"].number(), valuesOf(given)});
        if (keys.back().values.size() != keys.front().values.size()) given.fail("has another number of entries than in the keys before");
    }
    return keys;
}

std::vector<double> interpolated(const std::vector<Key>& keys, double time)
{
    const auto after = std::upper_bound(keys.begin(), keys.end(), time, [](double t, const Key& key) { return t < key.time; });
    if (after == keys.begin()) return keys.front().values;
    const Key& before = *(after - 1);
    if (after == keys.end()) return before.values;
    const double part = (time - before.time) / (after->time - before.time);
    std::vector<double> values = before.values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += (after->values[i] - values[i]) * part;
    return values;
}

/// `thing` without keys, its numbers those of `time`.
Json atTime(const JsonReader& thing, const KeyedNames& names, double time)
{
    Json json = thing.object();
    if (!thing.has("keys")) return json;
    keyTimesOf(thing, names);
    json.erase("keys");
    for (const std::string_view name : names) {
        const std::vector<Key> keys = keysOf(thing, name);
        if (keys.empty()) continue;
        const std::vector<double> values = interpolated(keys, time);
        json[std::string(name)] = values.size() == 1 ? Json(values.front()) : Json(values);
    }
    return json;
}

}  // namespace

std::vector<double> keyTimesOf(const JsonReader& thing, const KeyedNames& names)
{
    std::vector<double> times;
    if (!thing.has("keys")) return times;
    KeyedNames allowed = names;
    allowed.insert(allowed.begin(), "time");
    for (const JsonReader& key : thing["keys"].items()) {
        for (const auto& [name, value] : key.members())
            if (std::find(allowed.begin(), allowed.end(), name) == allowed.end()) key.fail("unknown key " + Json(name).dump() + "; known: " + joined(allowed));
        times.push_back(key["time"].number(-kLatestSecond, kLatestSecond));
        if (times.size() > 1 && !(times.back() > times[times.size() - 2]))
            key.fail("time", "must be later than the key before, at " + Json(times[times.size() - 2]).dump() + " s");
        if (key.object().size() == 1) key.fail("has a time and nothing else; give " + joined(names, {}, ", or "));
        for (const std::string_view name : names)
            if (key.has(std::string(name)) && thing.has(std::string(name))) thing.fail(std::string(name), "is given by the keys too; leave out one");
    }
    if (times.empty()) thing.fail("keys", "is empty");
    return times;
}

Moment::Moment(const JsonReader& thing, const KeyedNames& names, double time)
    : json_(atTime(thing, names, time)), reader_(thing.has("keys") ? thing.of(json_, " at " + Json(time).dump() + " s") : thing.of(json_, ""))
{
}

}  // namespace lrsm
