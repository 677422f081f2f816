#pragma once

#include "core/report/chart.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// The paper's equations, function by function, held against oracles that share no code with the kernels. Every worst case is searched for, not
/// sampled (worst_case.h), with a fixed seed: the same figures on every run of one machine, times apart.
namespace lrsm {

/// A limit, and the constant that code, docs and tests share: "kPolynomialCdfMaxError".
struct NamedBound {
    const char* name = "";
    double value = 0.0;
};

/// One function held against one oracle over one domain.
struct EquationCheck {
    std::string equation = {};  ///< number of the paper's equation ("12"); "sec5" for levels and footprints, "sec3" for voxels, "table1" for formats, "fig7"
                                ///< for cones, "base" for the elementary functions that all of them stand on
    std::string function = {};  ///< "gaussianVisibility, polynomial"
    std::string oracle = {};    ///< "50-digit erfc (Boost.Multiprecision)"
    std::string domain = {};    ///< in words, with ranges
    std::string errorKind = "absolute";  ///< what the three numbers below are: "absolute", "relative", "ULP", "wrong results"
    NamedBound bound = {};
    double worst = 0.0, meanError = 0.0;
    std::string worstInput = {};  ///< the input of the worst case, in digits that restore its bits
    std::uint64_t evaluations = 0;
    double nanoseconds = 0.0;  ///< median time of a call; 0: not measured

    /// False also where the error is NaN or nothing was evaluated.
    bool holds() const { return evaluations > 0 && worst <= bound.value; }
};

/// One end, or one point, of a choice of speed against accuracy: error beside time.
struct EquationTrade {
    std::string setting = {};                          ///< key in docs/settings.md: "gaussian", "storage", "half_rounding"
    std::string choice = {};                           ///< "table(256)", "float32", "nearest_even"
    std::string quantity = {};                         ///< what the error is of: "V, Eq. 12"
    double bound = 0.0, worst = 0.0, meanError = 0.0;  ///< absolute; signed mean in `bias`
    double bias = 0.0;
    double nanoseconds = 0.0;  ///< median time of a call; 0: not measured
    std::size_t bytes = 0;     ///< that the choice holds: the table, or one texel
};

struct EquationCurve {
    std::string equation;
    Chart chart;
};

struct EquationReport {
    std::vector<EquationCheck> checks;
    std::vector<EquationTrade> trades;
    std::vector<EquationCurve> curves;
    bool holds() const;  ///< of all checks
};

struct EquationOptions {
    std::optional<std::string> equation;  ///< this one alone; one of equationNames()
    bool measureSpeed = true;
    double effort = 1.0;  ///< budget of the searches: 1 takes about 20 s on one core, tests take less; > 0
    /// Called before each check with its function and the fraction done so far.
    std::function<void(const std::string&, double)> progress;
};

/// Names that EquationOptions::equation takes, in the report's order.
std::vector<std::string> equationNames();

/// Throws InputError for a name that is none of them.
EquationReport checkEquations(const EquationOptions& options = {});

}  // namespace lrsm
