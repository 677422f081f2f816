#pragma once

#include "apps/capture/capture.h"
#include "apps/check/candidate_map.h"

/// What somebody nearly called by a buffer's name (internal to the candidate's reader).
namespace lrsm {

struct NamedThing {
    std::string name;
    std::string where;  ///< for people: "all.exr, layer Normal"
};

/// A sentence for each name that is a buffer's but for case, separators or one letter, and for each key of the map that is of no buffer.
std::vector<std::string> nearMisses(const Capture& golden, const std::vector<NamedThing>& names, const std::vector<MapEntry>& map);

/// For a file that is of no buffer at all.
std::string unusedNote(const std::string& file, const Capture& golden);

}  // namespace lrsm
