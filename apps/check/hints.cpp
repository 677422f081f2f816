#include "apps/check/hints.h"

#include "apps/check/hint_trial.h"

#include <algorithm>

namespace lrsm {

namespace {

std::string range(const std::string& axis, std::size_t low, std::size_t high)
{
    if (low == high) return axis + " " + std::to_string(low);
    const std::string plural = axis.size() == 1 ? axis : axis + "s";
    return plural + " " + std::to_string(low) + "-" + std::to_string(high);
}

/// Wrong elements along one axis.
std::string alongAxis(const std::string& axis, const std::vector<std::size_t>& histogram)
{
    const std::size_t extent = histogram.size();
    std::size_t low = extent, high = 0, total = 0, even = 0;
    for (std::size_t i = 0; i < extent; ++i) {
        if (!histogram[i]) continue;
        low = std::min(low, i);
        high = i;
        total += histogram[i];
        even += i % 2 == 0 ? histogram[i] : 0;
    }
    if (extent < 2 || total == 0) return {};
    const std::string name = axis == "component" ? "" : axis;
    if (histogram[0] + histogram[extent - 1] == total && extent > 4 && low == 0 && high == extent - 1) return "the first and last " + axis;
    if ((high - low + 1) * 5 <= extent * 4) return range(axis, low, high);
    if (extent >= 8 && even == total) return "even " + axis + "s";
    if (extent >= 8 && even == 0) return "odd " + axis + "s";
    return {};
}

std::string componentList(const Buffer& buffer, const std::vector<std::size_t>& histogram)
{
    std::string names;
    std::size_t wrong = 0, of = 0;
    for (std::size_t c = 0; c < histogram.size(); ++c) {
        if (buffer.components[c].empty()) continue;
        ++of;
        if (!histogram[c]) continue;
        ++wrong;
        names += (names.empty() ? "'" : ", '") + buffer.components[c] + "'";
    }
    if (wrong == of) return {};
    return std::string(wrong == 1 ? "component " : "components ") + names;
}

/// What values have in common.
struct Signs {
    std::size_t larger = 0, smaller = 0, candidateZero = 0, goldenZero = 0, notANumber = 0, oneUp = 0, oneDown = 0, total = 0;
};

std::string valueText(const Signs& s, const Buffer& buffer)
{
    const auto all = [&](std::size_t n) { return n == s.total; };
    if (all(s.notANumber)) return "a NaN in all of them";
    if (all(s.candidateZero)) return "the candidate is 0 in all of them";
    if (all(s.goldenZero)) return "0 is expected in all of them";
    const bool ulp = buffer.tolerance.kind == Tolerance::Kind::ulp;
    if (ulp && all(s.oneUp)) return "the candidate is one step higher in all of them";
    if (ulp && all(s.oneDown)) return "the candidate is one step lower in all of them";
    if (buffer.encoding == Encoding::bits) return {};
    if (all(s.larger)) return "the candidate is larger in all of them";
    if (all(s.smaller)) return "the candidate is smaller in all of them";
    return {};
}

}  // namespace

std::vector<std::string> findHints(const HintQuestion& question)
{
    HintTrial trial(question);
    if (trial.sample().empty()) return {};
    suspectLayout(trial);
    suspectValues(trial);
    suspectMips(trial);
    suspectRounding(trial);
    suspectFormulas(trial);
    if (question.runPass) suspectPass(trial);
    return trial.spoken();
}

std::string whatTheyShare(const HintQuestion& question)
{
    const HintTrial trial(question);
    const Buffer& buffer = question.expected;
    const std::vector<std::size_t> extents = extentsOf(buffer);
    std::vector<std::vector<std::size_t>> histograms;
    for (const std::size_t extent : extents) histograms.emplace_back(extent, 0);
    Signs signs;
    for (std::size_t i = 0; i < trial.count(); ++i) {
        if (!trial.wrong(i)) continue;
        const std::vector<std::size_t> at = indicesOf(buffer, i);
        for (std::size_t axis = 0; axis < at.size(); ++axis) ++histograms[axis][at[axis]];
        const double g = trial.expectedAt(i), c = trial.candidateAt(i);
        ++signs.total;
        signs.larger += c > g ? 1 : 0;
        signs.smaller += c < g ? 1 : 0;
        signs.candidateZero += c == 0.0 ? 1 : 0;
        signs.goldenZero += g == 0.0 ? 1 : 0;
        signs.notANumber += std::isnan(c) || std::isnan(g) ? 1 : 0;
        const double steps = ordinalOf(buffer, c) - ordinalOf(buffer, g);
        signs.oneUp += steps == 1.0 ? 1 : 0;
        signs.oneDown += steps == -1.0 ? 1 : 0;
    }
    if (signs.total == 0) return {};

    std::string text;
    const std::vector<std::string> names = axisNamesOf(buffer);
    for (std::size_t axis = 0; axis < extents.size(); ++axis) {
        const bool component = axis + 1 == extents.size() && !buffer.components.empty();
        const std::string part = component ? componentList(buffer, histograms[axis]) : alongAxis(names[axis], histograms[axis]);
        if (!part.empty()) text += (text.empty() ? "all in " : ", ") + part;
    }
    const std::string values = valueText(signs, buffer);
    if (!values.empty()) text += (text.empty() ? "" : "; ") + values;
    return text;
}

}  // namespace lrsm
