#pragma once

#include "apps/capture/npy.h"

#include <cstddef>
#include <string>
#include <vector>

/// The paper's equations as arrays: inputs, exact results, and the error that is allowed, for functions that were written elsewhere. One set is one function
/// (or one that several equations share), a row one case.
namespace lrsm {

/// Of the table by which Eq. 12 is held to the paper's way.
inline constexpr int kVectorTableEntries = 1024;

/// Where a case comes from.
enum class CaseKind {
    typical,  ///< drawn from the domain
    worst,    ///< what a search found to be hardest for our own function
    extreme   ///< ends of the domain, and where something changes
};
std::string_view nameOf(CaseKind kind);

/// All cases of one input or output. The values are held in double, which holds those of every dtype here exactly.
struct VectorArray {
    std::string name;                     ///< input: within the set, "z_c"; output: unique, "eq12.visibility"
    std::vector<std::size_t> shape = {};  ///< of one case; empty: a number
    std::string unit, meaning;
    Dtype dtype = Dtype::f4;
    std::vector<double> values = {};  ///< case by case in C order; outputs: the exact results, rounded once

    std::size_t perCase() const;
    std::size_t cases() const { return values.size() / perCase(); }
};

struct VectorOutput {
    std::string equation;  ///< as EquationCheck::equation: "12", "sec5"
    VectorArray exact;
    std::string bound;            ///< what `allowed` is: "kDecayMaxError = 3e-07"
    std::vector<double> allowed;  ///< largest |result - exact|, an entry a value
    std::vector<double> ours;     ///< what the program's own function makes; files do not have it
};

struct VectorSet {
    std::string name, meaning;
    std::vector<VectorArray> inputs;
    std::vector<VectorOutput> outputs;
    std::vector<CaseKind> kinds;  ///< of each case

    std::size_t cases() const { return kinds.size(); }
};

/// One case of a set, input by input and output by output. Without results: not to be compared (a decision that rounding could turn).
struct VectorResult {
    std::vector<double> exact, allowed, ours;
};
struct VectorCase {
    std::vector<std::vector<double>> inputs;
    std::vector<VectorResult> results;
};

void addCase(VectorSet& set, CaseKind kind, const VectorCase& values);

/// Largest |ours - exact| / allowed of a case; infinite where none is allowed and they differ; -1 without results.
double hardness(const VectorCase& values);

/// "case 17 (worst): mu = 0.5, v = (0, 1, 0)", with digits that restore the bits; long arrays are left out.
std::string caseText(const VectorSet& set, std::size_t index);

}  // namespace lrsm
