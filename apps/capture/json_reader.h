#pragma once

#include "core/base/errors.h"
#include "core/base/math.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace lrsm {

/// A place in a JSON document that knows its path: what is missing or of the wrong kind is one line that names it.
class JsonReader {
  public:
    using Json = nlohmann::ordered_json;
    JsonReader(const Json& value, std::string path) : value_(&value), path_(std::move(path)) {}

    [[noreturn]] void fail(const std::string& why) const { throw InputError(path_, why); }
    const std::string& path() const { return path_; }
    const Json& json() const { return *value_; }

    bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
    JsonReader operator[](const char* key) const
    {
        if (!value_->is_object()) fail("must be an object");
        const auto found = value_->find(key);
        if (found == value_->end()) fail("lacks \"" + std::string(key) + "\"");
        return {*found, path_ + ": " + key};
    }
    std::vector<JsonReader> items() const
    {
        if (!value_->is_array()) fail("must be a list");
        std::vector<JsonReader> all;
        for (std::size_t i = 0; i < value_->size(); ++i) all.emplace_back((*value_)[i], path_ + "[" + std::to_string(i) + "]");
        return all;
    }
    std::vector<JsonReader> items(std::size_t count) const
    {
        std::vector<JsonReader> all = items();
        if (all.size() != count) fail("must have " + std::to_string(count) + " entries");
        return all;
    }

    bool isNull() const { return value_->is_null(); }
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
        const double value = value_->get<double>();
        if (!std::isfinite(value)) fail("must be finite");
        return value;
    }
    float real() const
    {
        const double value = number();
        if (std::abs(value) > double(std::numeric_limits<float>::max())) fail("does not fit float32");
        return static_cast<float>(value);
    }
    std::int64_t whole(std::int64_t least, std::int64_t most) const
    {
        const bool tooLarge =
            value_->is_number_unsigned() && value_->get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
        if (!value_->is_number_integer() || tooLarge || value_->get<std::int64_t>() < least || value_->get<std::int64_t>() > most)
            fail("must be a whole number in " + std::to_string(least) + " .. " + std::to_string(most));
        return value_->get<std::int64_t>();
    }
    Vec3 vector() const
    {
        const std::vector<JsonReader> xyz = items(3);
        return {xyz[0].real(), xyz[1].real(), xyz[2].real()};
    }
    std::vector<std::string> texts() const
    {
        std::vector<std::string> all;
        for (const JsonReader& item : items()) all.push_back(item.text());
        return all;
    }

  private:
    const Json* value_;
    std::string path_;
};

}  // namespace lrsm
