#pragma once

#include "reference/path_trace.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// What has been rendered so far as a file: exact sums, so that a run can be continued or joined with others to the last bit.
namespace lrsm {

/// What must agree before samples may be added: name and value, in order ("scene_sha256", "camera", "size", "transport", ...).
using Identity = std::vector<std::pair<std::string, std::string>>;

struct Checkpoint {
    Identity identity;
    double unit = 1.0;
    ReferenceState state;
};

/// Bytes of samples.bin: text header, little-endian arrays, SHA-256 of everything before it. Finished states of the same samples give the same
/// bytes, however they came about (the time spent is left out).
std::vector<std::byte> encodeCheckpoint(const Checkpoint& checkpoint);

/// Throws InputError, beginning with `place`, when the bytes are no checkpoint, of another version, cut short or damaged.
Checkpoint decodeCheckpoint(const std::vector<unsigned char>& bytes, const std::string& place);

/// Throws InputError naming the first thing that differs and both values.
void requireSameIdentity(const Identity& expected, const std::string& expectedPlace, const Identity& found, const std::string& place);

}  // namespace lrsm
