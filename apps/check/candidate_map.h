#pragma once

#include "apps/check/arrange.h"
#include "core/imageio/image_io.h"

#include <string>
#include <vector>

/// The JSON that says where a candidate's buffers are: docs/check.md, "The map" (internal to the candidate's reader).
namespace lrsm {

struct MapEntry {
    std::string pattern;               ///< buffer's name; may hold one '*'
    std::string file;                  ///< in the candidate's folder; a '*' stands for what the pattern's matched
    std::string layer;                 ///< of an EXR, or the array of an .npz; empty: the unnamed one, or the only one
    int mip = -1;                      ///< of a DDS; -1: the buffer's own
    std::string dtype;                 ///< of a raw file; empty: the golden's
    std::optional<Transfer> transfer;  ///< of an integer picture; nothing: sRGB for colours, else linear
    Arrangement how;
};

/// InputError "FILE: key: why".
std::vector<MapEntry> readCandidateMap(const std::string& path);

/// The entry for a buffer, its '*' filled in; the first that matches.
std::optional<MapEntry> entryFor(const std::vector<MapEntry>& map, const std::string& name);
bool matches(const MapEntry& entry, const std::string& name);

}  // namespace lrsm
