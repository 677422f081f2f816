#include "apps/validate/vectors/vector_set.h"

#include "apps/validate/equations/worst_case.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lrsm {
namespace {

/// Numbers of one case that are printed: a matrix would hide the rest.
constexpr std::size_t kPrinted = 4;

std::string valueText(const VectorArray& array, double value)
{
    return array.dtype == Dtype::f8 ? exactText(value) : exactText(static_cast<float>(value));
}

}  // namespace

std::string_view nameOf(CaseKind kind)
{
    return kind == CaseKind::typical ? "typical" : kind == CaseKind::worst ? "worst" : "extreme";
}

std::size_t VectorArray::perCase() const
{
    std::size_t count = 1;
    for (const std::size_t extent : shape) count *= extent;
    return count;
}

void addCase(VectorSet& set, CaseKind kind, const VectorCase& values)
{
    const auto append = [](std::vector<double>& to, const std::vector<double>& from) { to.insert(to.end(), from.begin(), from.end()); };
    set.kinds.push_back(kind);
    for (std::size_t i = 0; i < set.inputs.size(); ++i) append(set.inputs[i].values, values.inputs.at(i));
    for (std::size_t i = 0; i < set.outputs.size(); ++i) {
        const VectorResult& result = values.results.at(i);
        append(set.outputs[i].exact.values, result.exact);
        append(set.outputs[i].allowed, result.allowed);
        append(set.outputs[i].ours, result.ours);
    }
}

double hardness(const VectorCase& values)
{
    double largest = -1.0;
    for (const VectorResult& result : values.results)
        for (std::size_t i = 0; i < result.exact.size(); ++i) {
            const double error = result.ours[i] == result.exact[i] ? 0.0 : std::abs(result.ours[i] - result.exact[i]);
            largest = std::max(largest, error == 0.0 ? 0.0 : result.allowed[i] > 0.0 ? error / result.allowed[i] : std::numeric_limits<double>::infinity());
        }
    return largest;
}

std::string caseText(const VectorSet& set, std::size_t index)
{
    std::string text;
    for (const VectorArray& input : set.inputs) {
        const std::size_t count = input.perCase();
        if (count > kPrinted) continue;
        std::string numbers;
        for (std::size_t i = 0; i < count; ++i) numbers += (i ? ", " : "") + valueText(input, input.values[index * count + i]);
        text += (text.empty() ? ": " : ", ") + input.name + " = " + (count > 1 ? "(" + numbers + ")" : numbers);
    }
    return "case " + std::to_string(index) + " (" + std::string(nameOf(set.kinds[index])) + ")" + text;
}

}  // namespace lrsm
