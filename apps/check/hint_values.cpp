// Right places, values that are off by a formula.
#include "apps/check/hint_trial.h"
#include "core/base/formats.h"
#include "core/base/math.h"

#include <algorithm>
#include <array>

namespace lrsm {

namespace {

struct NamedFactor {
    double value;
    const char* name;
};
constexpr double kPiD = 3.14159265358979323846;
constexpr NamedFactor kFactors[] = {
    {kPiD, "pi"},
    {1 / kPiD, "1 / pi"},
    {2 * kPiD, "2 pi"},
    {0.5 / kPiD, "1 / (2 pi)"},
    {4 * kPiD, "4 pi"},
    {kPiD * kPiD, "pi^2"},
    {2.0, "2"},
    {0.5, "1 / 2"},
    {4.0, "4"},
    {0.25, "1 / 4"},
    {8.0, "8"},
    {0.125, "1 / 8"},
    {3.0, "3"},
    {1.0 / 3, "1 / 3"},
    {255.0, "255"},
    {1.0 / 255, "1 / 255"},
    {255.0 / 256, "255 / 256"},
    {256.0 / 255, "256 / 255"},
    {65535.0 / 65536, "65535 / 65536"},
    {65535.0, "65535"},
    {16.0, "16"},
    {1.0 / 16, "1 / 16"},
    {6.0, "6"},
    {1.0 / 6, "1 / 6"},
};
constexpr double kSameFactor = 4e-3;

std::string nameOfFactor(double factor)
{
    for (const NamedFactor& known : kFactors)
        if (std::abs(factor - known.value) <= kSameFactor * known.value) return known.name;
    return numberText(5, factor);
}

double median(std::vector<double>& values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

class ValueSuspicions {
  public:
    explicit ValueSuspicions(HintTrial& trial) : trial_(trial), unorm_(trial.expected().encoding == Encoding::unorm)
    {
        const Buffer& b = trial.expected();
        std::string names;
        std::size_t wrong = 0;
        for (std::size_t c = 0; c < b.components.size(); ++c)
            if (trial.wrongComponents()[c]) {
                names += (names.empty() ? "'" : ", '") + b.components[c] + "'";
                ++wrong;
            }
        const auto used = std::count_if(b.components.begin(), b.components.end(), [](const std::string& name) { return !name.empty(); });
        if (wrong > 0 && wrong < static_cast<std::size_t>(used)) who_ = names + (wrong == 1 ? " is " : " are ");
    }

    void run()
    {
        factors();
        signs();
        offsets();
        encodings();
        clippings();
        storages();
    }

  private:
    /// A formula applied to the components that are wrong at all; the others stay.
    template <class Formula>
    bool suspect(const std::string& text, const Formula& formula)
    {
        return trial_.suspect(who_ + text, [&](std::size_t i) {
            const double g = trial_.expectedAt(i);
            if (!trial_.wrongComponents().empty() && !trial_.wrongComponents()[i % trial_.components()]) return g;
            const double value = formula(g);
            return unorm_ ? std::clamp(value, 0.0, 1.0) : value;
        });
    }

    void factors()
    {
        std::vector<double> ratios;
        for (const std::size_t i : trial_.sample()) {
            const double g = trial_.expectedAt(i), c = trial_.candidateAt(i);
            if (g == 0.0 || c == 0.0 || !std::isfinite(c / g) || (unorm_ && c >= 1.0)) continue;
            ratios.push_back(c / g);
        }
        if (ratios.size() * 2 < trial_.sample().size() || ratios.empty()) return;
        const double factor = median(ratios);
        if (factor <= 0.0 || factor == 1.0) return;
        // A known constant, where the ratio is one, explains exactly what a measured one explains nearly.
        const std::string name = nameOfFactor(factor);
        for (const NamedFactor& known : kFactors)
            if (name == known.name && suspect("off by a constant factor: " + name + " times what is expected", [&](double g) { return g * known.value; }))
                return;
        suspect("off by a constant factor: " + numberText(5, factor) + " times what is expected", [&](double g) { return g * factor; });
    }

    void signs()
    {
        suspect("negated", [](double g) { return -g; });
        // Each element its own sign: not turned towards the eye or light, or an absolute value taken.
        trial_.suspect(who_ + "negated in some places and right in others (a vector not turned to its side)", [&](std::size_t i) {
            const double g = trial_.expectedAt(i);
            return trial_.fits(g, i) ? g : -g;
        });
    }

    void offsets()
    {
        std::vector<double> shifts;
        for (const std::size_t i : trial_.sample()) {
            const double g = trial_.expectedAt(i), c = trial_.candidateAt(i);
            if (std::isfinite(c - g)) shifts.push_back(c - g);
        }
        if (shifts.size() < 8) return;
        const double shift = median(shifts);
        if (shift != 0.0) suspect("off by a constant: " + numberText(5, shift) + " is added", [&](double g) { return g + shift; });
    }

    void encodings()
    {
        if (trial_.expected().encoding == Encoding::bits) return;
        suspect("stored as 0.5 + 0.5 x", [](double g) { return 0.5 + 0.5 * g; });
        suspect("stored as 2 x - 1", [](double g) { return 2.0 * g - 1.0; });
        suspect("1 - x", [](double g) { return 1.0 - g; });
        suspect("sRGB encoded (linear is expected)", [](double g) { return g <= 0.0031308 ? 12.92 * g : 1.055 * std::pow(g, 1.0 / 2.4) - 0.055; });
        suspect("decoded from sRGB once too often", [](double g) { return g <= 0.04045 ? g / 12.92 : std::pow((g + 0.055) / 1.055, 2.4); });
        suspect("raised to 1 / 2.2 (gamma)", [](double g) { return std::pow(g, 1.0 / 2.2); });
        suspect("raised to 2.2 (gamma)", [](double g) { return std::pow(g, 2.2); });
        suspect("the square of what is expected", [](double g) { return g * g; });
        suspect("the square root of what is expected", [](double g) { return std::sqrt(g); });
        suspect("the reciprocal of what is expected", [](double g) { return 1.0 / g; });
    }

    void clippings()
    {
        suspect("clipped to [0, 1]", [](double g) { return std::clamp(g, 0.0, 1.0); });
        suspect("clipped at 1", [](double g) { return std::min(g, 1.0); });
        suspect("clipped at 0", [](double g) { return std::max(g, 0.0); });
        suspect("an absolute value", [](double g) { return std::abs(g); });
    }

    void storages()
    {
        if (trial_.expected().encoding != Encoding::number) return;
        suspect("stored in 8 bits (UNORM)", [](double g) { return std::floor(std::clamp(g, 0.0, 1.0) * 255.0 + 0.5) / 255.0; });
        if (trial_.expected().dtype != Dtype::f4) return;
        suspect("stored as half, rounded toward zero", [](double g) { return double(floatFromHalf(halfFromFloat(float(g), HalfRounding::d3d))); });
        suspect("stored as half, rounded to nearest even", [](double g) { return double(floatFromHalf(halfFromFloat(float(g), HalfRounding::nearestEven))); });
    }

    HintTrial& trial_;
    bool unorm_;
    std::string who_;
};

/// All or most of it never written.
void suspectConstant(HintTrial& trial)
{
    const double first = trial.candidateAt(trial.sample().front());
    if (trial.expected().encoding == Encoding::bits) return;
    trial.suspect(std::isnan(first) ? "all is NaN" : "every element is " + numberText(5, first) + (first == 0.0 ? ": never written?" : ""),
                  [&](std::size_t) { return first; });
}

/// Vectors of three: normals scaled, or unit where they should carry a weight.
void suspectLengths(HintTrial& trial)
{
    const Buffer& b = trial.expected();
    if (b.components.size() < 3 || b.components[0] != "x" || b.components[2] != "z") return;
    const std::size_t n = b.components.size();
    const auto lengthAt = [&](std::size_t i, auto&& value) {
        const std::size_t texel = i - i % n;
        const double x = value(texel), y = value(texel + 1), z = value(texel + 2);
        return std::sqrt(x * x + y * y + z * z);
    };
    const auto expected = [&](std::size_t i) { return trial.expectedAt(i); };
    const auto candidate = [&](std::size_t i) { return trial.candidateAt(i); };
    trial.suspect("normalised to unit length, which is not expected here", [&](std::size_t i) {
        const double length = lengthAt(i, expected);
        return i % n > 2 || length == 0.0 ? trial.expectedAt(i) : trial.expectedAt(i) / length;
    });
    trial.suspect("not of the expected length: directions are right (normalize is missing?)", [&](std::size_t i) {
        const double own = lengthAt(i, candidate), length = lengthAt(i, expected);
        return i % n > 2 || own == 0.0 || length == 0.0 ? trial.expectedAt(i) : trial.expectedAt(i) / length * own;
    });
}

}  // namespace

void suspectValues(HintTrial& trial)
{
    suspectConstant(trial);
    if (trial.expected().encoding == Encoding::bits) return;
    ValueSuspicions(trial).run();
    suspectLengths(trial);
}

}  // namespace lrsm
