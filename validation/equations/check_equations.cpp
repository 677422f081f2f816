#include "validation/equations/check_equations.h"

#include "core/base/check.h"

#include <algorithm>

namespace lrsm {

bool EquationReport::holds() const
{
    return !checks.empty() && std::all_of(checks.begin(), checks.end(), [](const EquationCheck& check) { return check.holds(); });
}

std::vector<std::string> equationNames()
{
    return {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "sec3", "sec5", "fig7", "table1", "base"};
}

EquationReport checkEquations(const EquationOptions& options)
{
    const std::vector<std::string> names = equationNames();
    if (options.equation && std::find(names.begin(), names.end(), *options.equation) == names.end()) {
        std::string known;
        for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
        throw InputError("equation \"" + *options.equation + "\"", "there is no check of this name; there are " + known);
    }
    return {};
}

}  // namespace lrsm
