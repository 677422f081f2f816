#pragma once

#include "core/base/errors.h"
#include "core/base/math.h"
#include "core/base/text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Reading JSON that others wrote: what is missing or of the wrong kind is one InputError that names the place. Of headers alone, so that core/base
/// stays without the library: whoever includes it links nlohmann_json::nlohmann_json.
namespace lrsm {

/// Anything nested deeper is refused: the library and tinygltf recurse where they write or convert, and real files stay below 20.
inline constexpr int kMaxJsonDepth = 128;

/// InputError "PLACE: is no JSON: line 1, column 2: why; FIX".
inline nlohmann::ordered_json parseJson(std::string_view text, const std::string& place, const std::string& fix = "")
{
    using Json = nlohmann::ordered_json;
    const auto notTooDeep = [&](int depth, Json::parse_event_t, Json&) {
        if (depth > kMaxJsonDepth) throw InputError(place, "is nested more than " + std::to_string(kMaxJsonDepth) + " deep");
        return true;
    };
    try {
        return Json::parse(text, notTooDeep);
    } catch (const Json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 1, column 2: ...": the first words tell a user nothing.
        const std::string_view why = error.what();
        const std::size_t line = why.find("line "), end = why.find("] ");
        const std::size_t begin = line != std::string_view::npos ? line : end != std::string_view::npos ? end + 2 : 0;
        throw InputError(place, "is no JSON: " + std::string(why.substr(begin)) + (fix.empty() ? "" : "; " + fix));
    }
}

inline nlohmann::ordered_json parseJson(const std::vector<unsigned char>& bytes, const std::string& place, const std::string& fix = "")
{
    return parseJson(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), place, fix);
}

/// A place in a JSON document that knows its path: "FILE: camera.eye[0]".
class JsonReader {
  public:
    using Json = nlohmann::ordered_json;

    /// `value` must outlive the reader. `separator` stands between the keys of a path.
    JsonReader(const Json& value, std::string file, const char* separator = ".") : JsonReader(value, std::move(file), ": ", separator) {}

    [[noreturn]] void fail(const std::string& why) const { throw InputError(path_, why); }
    [[noreturn]] void fail(const std::string& key, const std::string& why) const { throw InputError(path_ + toKey_ + key, why); }
    const std::string& path() const { return path_; }
    const Json& json() const { return *value_; }

    /// json(), which must be an object.
    const Json& object() const
    {
        if (!value_->is_object()) fail("must be an object");
        return *value_;
    }

    bool isNull() const { return value_->is_null(); }
    bool has(const std::string& key) const { return object().contains(key); }
    /// The member; where there is none, an error that names it.
    JsonReader operator[](const std::string& key) const
    {
        const auto found = object().find(key);
        if (found == value_->end()) fail(key, "is missing");
        return {*found, path_ + toKey_ + key, separator_, separator_};
    }
    std::vector<std::pair<std::string, JsonReader>> members() const
    {
        std::vector<std::pair<std::string, JsonReader>> all;
        for (const auto& [key, value] : object().items()) all.push_back({key, JsonReader(value, path_ + toKey_ + key, separator_, separator_)});
        return all;
    }
    void allowOnly(std::initializer_list<std::string_view> keys) const
    {
        for (const auto& [key, unused] : object().items())
            if (std::find(keys.begin(), keys.end(), key) == keys.end()) fail("unknown key " + Json(key).dump() + "; known: " + joined(keys));
    }

    /// Another value in this one's place; `note` follows the place. `value` must outlive the reader.
    JsonReader of(const Json& value, const std::string& note) const { return {value, path_ + note, note.empty() ? toKey_ : ": ", separator_}; }

    std::vector<JsonReader> items() const
    {
        if (!value_->is_array()) fail("must be a list");
        std::vector<JsonReader> all;
        for (const Json& item : *value_) all.push_back({item, path_ + "[" + std::to_string(all.size()) + "]", toKey_, separator_});
        return all;
    }
    std::vector<JsonReader> items(std::size_t count) const
    {
        std::vector<JsonReader> all = items();
        if (all.size() != count) fail("must have " + std::to_string(count) + " entries");
        return all;
    }

    bool flag() const
    {
        if (!value_->is_boolean()) fail("must be true or false");
        return value_->get<bool>();
    }
    std::string text() const
    {
        if (!value_->is_string()) fail("must be a string");
        return value_->get<std::string>();
    }
    double number() const
    {
        if (!value_->is_number()) fail("must be a number");
        return value_->get<double>();
    }
    double number(double least, double most) const
    {
        const double value = number();
        if (!(value >= least && value <= most)) fail(value_->dump() + " is out of range [" + Json(least).dump() + ", " + Json(most).dump() + "]");
        return value;
    }
    float real() const
    {
        const double value = number();
        if (!(std::abs(value) <= double(std::numeric_limits<float>::max()))) fail("does not fit float32");
        return static_cast<float>(value);
    }
    std::int64_t whole(std::int64_t least, std::int64_t most) const
    {
        const bool tooLarge = value_->is_number_unsigned() && value_->get<std::uint64_t>() > std::uint64_t(std::numeric_limits<std::int64_t>::max());
        if (!value_->is_number_integer() || tooLarge || value_->get<std::int64_t>() < least || value_->get<std::int64_t>() > most)
            fail("must be a whole number in " + std::to_string(least) + " .. " + std::to_string(most));
        return value_->get<std::int64_t>();
    }
    std::uint64_t count() const
    {
        if (!value_->is_number_integer() || (!value_->is_number_unsigned() && value_->get<std::int64_t>() < 0)) fail("must be a whole number, not negative");
        return value_->get<std::uint64_t>();
    }
    Vec3 vector() const
    {
        if (!value_->is_array() || value_->size() != 3) fail("must be an array of 3 numbers");
        const std::vector<JsonReader> xyz = items();
        return {xyz[0].real(), xyz[1].real(), xyz[2].real()};
    }
    std::vector<std::string> texts() const
    {
        std::vector<std::string> all;
        for (const JsonReader& item : items()) all.push_back(item.text());
        return all;
    }

  private:
    JsonReader(const Json& value, std::string path, const char* toKey, const char* separator)
        : value_(&value), path_(std::move(path)), toKey_(toKey), separator_(separator)
    {
    }

    const Json* value_;
    std::string path_;
    const char *toKey_, *separator_;  ///< what stands before a key of this value, and of those below it
};

}  // namespace lrsm
