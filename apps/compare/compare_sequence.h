#pragma once

#include <optional>
#include <string>
#include <vector>

/// lrsm compare --sequence: two sequences frame by frame, what flickers, and when.
namespace lrsm {

struct SequenceComparison {
    std::string test, reference;  ///< folders of frames
    std::string output;           ///< folder for page, numbers, pictures; empty: none
    std::vector<std::string> layers, failAbove;
    std::optional<float> exposureStops;
    bool allPixels = false, allowNan = false, quiet = false, json = false;
};

/// Returns the exit code: 1 where a limit is passed. Throws InputError.
int compareSequences(const SequenceComparison& options);

}  // namespace lrsm
