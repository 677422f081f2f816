#pragma once

#include "apps/validate/vectors/vector_set.h"

/// Results that were computed elsewhere, held against the exact ones.
namespace lrsm {

enum class OutputVerdict {
    ok,
    wrong,
    missing,    ///< not given: no failure
    unreadable  ///< a file is there, but damaged, of another shape, or called otherwise
};
std::string_view nameOf(OutputVerdict verdict);

struct JudgedOutput {
    const VectorSet* set = nullptr;
    const VectorOutput* output = nullptr;
    OutputVerdict verdict = OutputVerdict::missing;
    std::string note = {};       ///< one line: why it was not judged, or what is odd about the file
    std::size_t outside = 0;     ///< values whose error is more than is allowed
    std::size_t notANumber = 0;  ///< NaN where the exact result is none
    // Absolute, and in ULPs of the output's format at the exact result; infinite where a value is not finite.
    double worst = 0.0, mean = 0.0, worstUlp = 0.0, meanUlp = 0.0;
    std::size_t worstValue = 0;  ///< the value with the largest error over what is allowed
    double given = 0.0;          ///< there

    std::size_t worstCase() const { return worstValue / output->exact.perCase(); }
};

struct Judgement {
    std::vector<JudgedOutput> outputs;  ///< in the paper's order
    std::vector<std::string> notes;     ///< of files that are of no output

    std::size_t count(OutputVerdict verdict) const;
    /// Something was judged, nothing is wrong, nothing unreadable.
    bool holds() const;
    /// 0, 1 if something is wrong; 2 if nothing is, but something is unreadable or nothing was given.
    int exitCode() const;
};

/// One output's results, of any type, against the exact ones. `given` must have as many values.
JudgedOutput judgeValues(const VectorSet& set, const VectorOutput& output, const std::vector<double>& given);

/// `folder` holds NAME.npy for some or all outputs; the sets must outlive what comes back. InputError where there is no such folder.
Judgement judgeFolder(const std::vector<VectorSet>& sets, const std::string& folder);

}  // namespace lrsm
