#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// Lists in text.
namespace lrsm {

/// "a, b, c": text(item) of each.
template <class Items, class Text = std::identity>
std::string joined(const Items& items, const Text& text = {}, std::string_view separator = ", ")
{
    std::string all;
    bool first = true;
    for (const auto& item : items) {
        if (!first) all += separator;
        all += std::invoke(text, item);
        first = false;
    }
    return all;
}

/// What stands between the separators, empty parts included; one part of a text without any.
std::vector<std::string> split(std::string_view text, std::string_view separator);

/// Levenshtein distance: how many letters to change, add or drop.
std::size_t editDistance(std::string_view a, std::string_view b);

}  // namespace lrsm
