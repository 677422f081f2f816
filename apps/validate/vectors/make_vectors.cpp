#include "apps/validate/vectors/make_vectors.h"

#include "apps/validate/equations/check_equations.h"
#include "core/base/errors.h"
#include "core/base/text.h"

#include <algorithm>

namespace lrsm {

void keepEquation(std::vector<VectorSet>& sets, const std::string& equation)
{
    const std::vector<std::string> names = equationNames();
    if (std::find(names.begin(), names.end(), equation) == names.end())
        throw InputError("equation \"" + equation + "\"", "there is no check of this name; there are " + joined(names));
    for (VectorSet& set : sets) std::erase_if(set.outputs, [&](const VectorOutput& output) { return output.equation != equation; });
    std::erase_if(sets, [](const VectorSet& set) { return set.outputs.empty(); });
}

std::vector<VectorSet> makeVectors(const std::string& equation)
{
    std::vector<VectorSet> sets;
    for (const auto add : {addMarchVectors, addSurfaceVectors, addSampleVectors, addLayerVectors, addVoxelVectors, addFormatVectors, addElementaryVectors})
        add(sets);
    if (!equation.empty()) keepEquation(sets, equation);
    const std::vector<std::string> names = equationNames();
    // A set stands where its first equation does.
    const auto place = [&](const VectorSet& set) { return std::find(names.begin(), names.end(), set.outputs.front().equation) - names.begin(); };
    std::stable_sort(sets.begin(), sets.end(), [&](const VectorSet& a, const VectorSet& b) { return place(a) < place(b); });
    return sets;
}

}  // namespace lrsm
