#pragma once

#include "apps/validate/equations/check_equations.h"

namespace lrsm::test {

inline EquationOptions quick(double effort)
{
    EquationOptions options;
    options.effort = effort;
    options.measureSpeed = false;
    return options;
}

/// All checks at a tenth of the full effort, run once a program.
inline const EquationReport& quickReport()
{
    static const EquationReport report = checkEquations(quick(0.1));
    return report;
}

}  // namespace lrsm::test
