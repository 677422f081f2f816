#pragma once

#include "apps/check/candidate.h"
#include "apps/check/compare.h"

#include <functional>

/// A candidate held against a golden capture, pass by pass in the order of the data flow.
namespace lrsm {

enum class Verdict {
    ok,  ///< within the tolerance of the golden; with fromGolden: of what our pass makes of the candidate's own inputs
    wrong,
    inherits,    ///< differs from the golden, but is what our pass makes of the candidate's inputs: look upstream
    missing,     ///< not in the candidate
    unreadable,  ///< there, but no buffer of this shape and type
};
/// For people, and in files: "not in candidate", "not_in_candidate".
struct VerdictName {
    std::string_view text, key;
};
VerdictName nameOf(Verdict verdict);

struct CheckedBuffer {
    const Buffer* golden = nullptr;
    const CandidateBuffer* candidate = nullptr;  ///< nullptr: missing
    BufferComparison againstGolden;
    std::optional<BufferComparison> againstRerun;  ///< fromGolden, where the pass could be run anew
    Buffer rerun;                                  ///< what it made; no bytes without
    Verdict verdict = Verdict::missing;
    std::string note;                ///< why it could not be run anew, say; may be empty
    std::vector<std::string> hints;  ///< what the error looks like, surest first
    std::string where;               ///< what the differing elements have in common; may be empty

    /// What the verdict was made of: the pass run anew; the golden where there is no such thing, or where only the golden is matched.
    bool judgedByRerun() const { return againstRerun && (againstRerun->holds || !againstGolden.holds); }
    const Buffer& expected() const { return judgedByRerun() ? rerun : *golden; }
    const BufferComparison& comparison() const { return judgedByRerun() ? *againstRerun : againstGolden; }
};

struct CheckOptions {
    bool fromGolden = false;          ///< run each pass of ours anew on what the candidate has for its inputs
    std::vector<std::string> passes;  ///< "lrsm" means every light's; empty: all
    bool hints = true;
    std::function<void(const std::string& pass, double fraction)> progress;  ///< may be empty
};

struct CheckReport {
    std::vector<CheckedBuffer> buffers;  ///< data flow: pass, then mip, then the golden's order
    std::vector<std::string> notes;

    /// nullptr when all is well.
    const CheckedBuffer* firstWrong() const;
    bool holds() const { return firstWrong() == nullptr && count(Verdict::unreadable) == 0; }
    std::size_t count(Verdict verdict) const;
    /// One line: the first wrong pass, buffer, texel and term, and what it looks like; or that all is within the tolerances.
    std::string summary() const;
};

/// Makes every tolerance "exact": for candidates that this very program made, on another machine or with another compiler.
void demandBits(Capture& golden);

/// Both must outlive the report. InputError for an unknown pass in `passes`, and when there is no buffer in common: with why,
/// and with what is nearly one.
CheckReport checkCandidate(const Capture& golden, const Candidate& candidate, const CheckOptions& options = {});

}  // namespace lrsm
