// Mip levels and their rounding.
#include "apps/capture/passes.h"
#include "apps/check/hint_trial.h"
#include "core/base/formats.h"

#include <algorithm>
#include <array>

namespace lrsm {

namespace {

/// Texel of the level below (or of any finer level) that a child offset names, for an element of this level.
class Family {
  public:
    Family(const Buffer& level, const Buffer& other) : otherExtents_(extentsOf(other)), names_(axisNamesOf(level)), extents_(extentsOf(level))
    {
        for (std::size_t axis = 0; axis < extents_.size(); ++axis) {
            const std::string& name = names_[axis];
            if (name != "component" && name != "layer") halved_.push_back(axis);
        }
    }
    std::size_t dimensions() const { return halved_.size(); }

    /// `child`: one bit an axis, the last axis lowest.
    std::size_t child(std::size_t element, std::size_t child) const
    {
        return mapped(element, [&](std::size_t i, std::size_t axis) { return 2 * i + (child >> (halved_.size() - 1 - axis) & 1u); });
    }
    std::size_t parent(std::size_t element) const
    {
        return mapped(element, [](std::size_t i, std::size_t) { return i / 2; });
    }
    /// The same coordinates.
    std::size_t corner(std::size_t element) const
    {
        return mapped(element, [](std::size_t i, std::size_t) { return i; });
    }

  private:
    template <class Map>
    std::size_t mapped(std::size_t element, const Map& map) const
    {
        std::size_t at = 0, stride = 1;
        for (std::size_t axis = extents_.size(); axis-- > 0;) {
            std::size_t i = element % extents_[axis];
            element /= extents_[axis];
            const auto halved = std::find(halved_.begin(), halved_.end(), axis);
            if (halved != halved_.end()) i = std::min(map(i, static_cast<std::size_t>(halved - halved_.begin())), otherExtents_[axis] - 1);
            at += i * stride;
            stride *= otherExtents_[axis];
        }
        return at;
    }

    std::vector<std::size_t> otherExtents_;
    std::vector<std::string> names_;
    std::vector<std::size_t> extents_, halved_;
};

const Buffer* levelBeside(const HintTrial& trial, int by)
{
    const std::string& name = trial.expected().name;
    const int level = levelOf(name) + by;
    return isMip(name) && level >= 0 ? trial.inputs().find(mipName(stemOf(name), level)) : nullptr;
}

void suspectPicking(HintTrial& trial, const Buffer& below)
{
    const Family family(trial.expected(), below);
    const std::size_t children = std::size_t(1) << family.dimensions();
    const std::string block = family.dimensions() == 3 ? "2x2x2" : "2x2";
    const std::string of = " of each " + block + " of " + below.name;
    for (std::size_t child = 0; child < children; ++child) {
        std::string which;
        for (std::size_t axis = 0; axis < family.dimensions(); ++axis) which += std::to_string(child >> (family.dimensions() - 1 - axis) & 1u);
        trial.suspect("it is texel " + which + of + ", not their mean", [&](std::size_t i) { return decodedValue(below, family.child(i, child)); });
    }
    const auto over = [&](std::size_t i, double start, auto&& fold) {
        double value = start;
        for (std::size_t child = 0; child < children; ++child) value = fold(value, decodedValue(below, family.child(i, child)));
        return value;
    };
    trial.suspect("it is the largest" + of, [&](std::size_t i) { return over(i, -INFINITY, [](double a, double b) { return std::max(a, b); }); });
    trial.suspect("it is the smallest" + of, [&](std::size_t i) { return over(i, INFINITY, [](double a, double b) { return std::min(a, b); }); });
    trial.suspect("it is the sum" + of + ", not the mean", [&](std::size_t i) { return over(i, 0.0, [](double a, double b) { return a + b; }); });
    // What is 0 taken for what is not there: weights that should be carried by alpha.
    trial.suspect("it is the mean over those" + of + " that are not 0", [&](std::size_t i) {
        double sum = 0.0, count = 0.0;
        for (std::size_t child = 0; child < children; ++child) {
            const double value = decodedValue(below, family.child(i, child));
            sum += value;
            count += value != 0.0 ? 1.0 : 0.0;
        }
        return count > 0.0 ? sum / count : 0.0;
    });
    trial.suspect("level off by one: it holds a corner of " + below.name, [&](std::size_t i) { return decodedValue(below, family.corner(i)); });
}

constexpr double kTieSteps = 65536.0;

/// How a value becomes a code.
struct Quantiser {
    const char* text;
    double (*code)(double ordinal);
};
constexpr Quantiser kQuantisers[] = {
    {"rounds to nearest even", [](double o) { return o - std::remainder(o, 1.0); }},
    {"rounds toward zero (truncates)", [](double o) { return std::trunc(o); }},
    {"rounds to nearest, halves up", [](double o) { return std::floor(o + 0.5); }},
    {"rounds away from zero (up)", [](double o) { return o < 0.0 ? std::floor(o) : std::ceil(o); }},
};

/// Wrong codes with each quantiser, given what is to be rounded; a suspicion when one leaves hardly any.
template <class Wide>
void suspectQuantisers(HintTrial& trial, const std::string& ours, const Wide& wide)
{
    const Buffer& expected = trial.expected();
    const Buffer& candidate = trial.question().candidate.buffer;
    std::array<std::size_t, std::size(kQuantisers)> left{};
    std::size_t before = 0, considered = 0;
    for (std::size_t i = 0; i < trial.count(); ++i) {
        if (!compared(expected, i)) continue;
        const double value = wide(i);
        if (std::isnan(value)) continue;
        ++considered;
        // Sums of codes are exact but for the division: ties must stay ties.
        const double code = ordinalOf(expected, decodedValue(candidate, i)), exact = std::round(ordinalOf(expected, value) * kTieSteps) / kTieSteps;
        before += code != ordinalOf(expected, decodedValue(expected, i)) ? 1 : 0;
        for (std::size_t q = 0; q < left.size(); ++q) left[q] += std::abs(code - kQuantisers[q].code(exact)) > 1e-3 ? 1 : 0;
    }
    if (considered == 0) return;
    for (std::size_t q = 0; q < left.size(); ++q)
        if (trial.note(std::string(kQuantisers[q].text) + " instead of " + ours, left[q], before)) return;
}

std::string ownRounding(const HintTrial& trial)
{
    const Buffer& expected = trial.expected();
    if (expected.encoding == Encoding::unorm) return "to nearest (UNORM: times 2^n - 1, plus 0.5, drop the fraction)";
    return halfRoundingOf(trial.inputs().settings, expected.pass) == HalfRounding::d3d ? "toward zero (half_rounding=d3d)"
                                                                                       : "to nearest even (half_rounding=nearest_even)";
}

}  // namespace

void suspectMips(HintTrial& trial)
{
    if (const Buffer* below = levelBeside(trial, -1)) suspectPicking(trial, *below);
    if (const Buffer* above = levelBeside(trial, 1)) {
        const Family family(trial.expected(), *above);
        trial.suspect("level off by one: it repeats " + above->name, [&](std::size_t i) { return decodedValue(*above, family.parent(i)); });
    }
}

void suspectRounding(HintTrial& trial)
{
    const Buffer& expected = trial.expected();
    const bool codes = expected.encoding == Encoding::unorm, half = expected.dtype == Dtype::f2;
    if (!codes && !half) return;
    if (expected.pass == "vct mips" || expected.pass == "rc mips") return;  // front over back, surface coverage: no means of the level below
    const Buffer* below = levelBeside(trial, -1);
    // Directional voxel levels 1 to 3 count columns: they are no means of the level below.
    const bool columns = expected.pass == "voxel mips" && levelOf(expected.name) <= 3 && expected.components.size() == 3;
    if (below && below->dtype == expected.dtype && !columns && !(expected.pass == "voxel mips" && trial.inputs().settings.voxel.mipFilter != MipFilter::mean)) {
        const Family family(expected, *below);
        const std::size_t children = std::size_t(1) << family.dimensions();
        suspectQuantisers(trial, ownRounding(trial), [&](std::size_t i) {
            double sum = 0.0;
            for (std::size_t child = 0; child < children; ++child) sum += decodedValue(*below, family.child(i, child));
            return sum / static_cast<double>(children);
        });
        return;
    }
    const std::optional<Buffer> wide = wideOutput(trial.inputs(), expected.name);
    if (wide) suspectQuantisers(trial, ownRounding(trial), [&](std::size_t i) { return decodedValue(*wide, i); });
}

}  // namespace lrsm
