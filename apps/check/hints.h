#pragma once

#include "apps/check/candidate.h"
#include "apps/check/compare.h"

/// From the differences to the bug: suspicions, each tested on all elements of the buffer before it is spoken.
namespace lrsm {

struct HintQuestion {
    const Capture& inputs;  ///< what the pass read: the golden, or the candidate laid over it
    const Buffer& expected;
    const CandidateBuffer& candidate;
    const BufferComparison& comparison;
    bool runPass = true;  ///< also run the pass with other settings and other inputs, where it can be
};

/// What the wrong elements have in common: "all in layer 1, columns 120-127, component 'z2'; the candidate is 0 in all of them". May be empty.
std::string whatTheyShare(const HintQuestion& question);

/// At most three, surest first, as "rows are flipped (explains all 412)". A suspicion is spoken when it explains at least 98 % of the wrong elements
/// and makes no others wrong; when there is none such, the best that explains most of them, with its share.
std::vector<std::string> findHints(const HintQuestion& question);

}  // namespace lrsm
