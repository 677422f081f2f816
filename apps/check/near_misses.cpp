#include "apps/check/near_misses.h"

#include "core/base/text.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace lrsm {

namespace {

std::string lowered(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Letters and digits alone: "GBuffer_Normal" and "gbuffer.normal" are the same.
std::string bareName(const std::string& text)
{
    std::string bare = lowered(text);
    std::erase_if(bare, [](unsigned char c) { return !std::isalnum(c); });
    return bare;
}

/// The question, or "" where nothing is near.
std::string didYouMean(const Capture& golden, const std::string& name)
{
    const std::string bare = bareName(name);
    for (const Buffer& buffer : golden.buffers) {
        if (name == buffer.name) return {};
        const std::string wanted = bareName(buffer.name);
        // Digits tell mips and lights apart: one that differs is another buffer.
        if (bare == wanted || (!std::isdigit(static_cast<unsigned char>(bare.empty() ? '0' : bare.back())) && editDistance(bare, wanted) == 1))
            return "; did you mean " + buffer.name + "?" + (lowered(name) == buffer.name ? " (names are told apart by case)" : "");
    }
    return {};
}

}  // namespace

std::vector<std::string> nearMisses(const Capture& golden, const std::vector<NamedThing>& names, const std::vector<MapEntry>& map)
{
    std::vector<std::string> misses;
    for (const NamedThing& thing : names)
        if (const std::string question = didYouMean(golden, thing.name); !question.empty())
            misses.push_back(thing.where + " is of no buffer of the golden" + question);
    for (const MapEntry& entry : map)
        if (std::none_of(golden.buffers.begin(), golden.buffers.end(), [&](const Buffer& b) { return matches(entry, b.name); }))
            misses.push_back("the map's key \"" + entry.pattern + "\" is of no buffer of the golden" + didYouMean(golden, entry.pattern));
    return misses;
}

std::string unusedNote(const std::string& file, const Capture& golden)
{
    const std::string stem = std::filesystem::path(file).stem().string();
    std::string nearest;
    std::size_t least = std::max<std::size_t>(stem.size() / 3, 2);
    for (const Buffer& buffer : golden.buffers)
        if (const std::size_t distance = editDistance(stem, buffer.name); distance <= least && distance > 0) {
            least = distance - 1;
            nearest = buffer.name;
        }
    return file + " is of no buffer of the golden" + (nearest.empty() ? "" : "; did you mean " + nearest + "?");
}

}  // namespace lrsm
