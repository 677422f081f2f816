#pragma once

#include "core/base/rng.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

/// A search for the input that a function gets most wrong. Sampling alone misses worst cases: they sit on single floats beside a boundary, or on
/// spikes between samples. So: every planted boundary with its neighbours in ULPs, a stratified sweep of the domain, and hill climbing in ULPs from
/// the worst point of each part of the sweep. Deterministic: Philox with a fixed key.
namespace lrsm {

enum class Spacing {
    linear,
    logarithmic,       ///< low > 0
    signedLogarithmic  ///< either sign, magnitudes from low > 0 to high
};

template <class T>
struct Axis {
    T low, high;
    Spacing spacing = Spacing::linear;
};

/// The domain of a search: closed intervals, and the points where something changes (cell edges, clamps, joins of two branches).
template <class T, std::size_t N>
struct SearchSpace {
    std::array<Axis<T>, N> axes;
    std::vector<std::array<T, N>> planted = {};
};

struct SearchBudget {
    std::uint64_t sweep = 20000;  ///< points of the sweep
    std::uint64_t climb = 20000;  ///< steps of all climbs together
};

template <class T, std::size_t N>
struct Worst {
    std::array<T, N> input{};
    double error = -1.0;  ///< -1: nothing was comparable
    double sum = 0.0;     ///< of errors over the sweep, which is no worse than a fair sample of the domain
    std::uint64_t swept = 0;
    std::uint64_t evaluations = 0;
    double mean() const { return swept ? sum / static_cast<double>(swept) : 0.0; }
    void include(const Worst& other)
    {
        if (other.error > error) error = other.error, input = other.input;
        sum += other.sum;
        swept += other.swept;
        evaluations += other.evaluations;
    }
};

/// `x` moved by `steps` ULPs, through 0 if need be; finite. -0 counts as 0.
template <class T>
T moveByUlps(T x, std::int64_t steps)
{
    using Bits = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
    constexpr Bits kSign = std::numeric_limits<Bits>::min();
    const Bits bits = std::bit_cast<Bits>(x);
    const auto ordered = static_cast<std::int64_t>(bits < 0 ? static_cast<Bits>(kSign - bits) : bits);
    const auto largest = static_cast<std::int64_t>(std::bit_cast<Bits>(std::numeric_limits<T>::max()));
    const std::int64_t moved = steps > 0 ? (ordered > largest - steps ? largest : ordered + steps) : (ordered < -largest - steps ? -largest : ordered + steps);
    return std::bit_cast<T>(moved < 0 ? static_cast<Bits>(kSign - static_cast<Bits>(moved)) : static_cast<Bits>(moved));
}

/// Uniform words by counter: stream, index, and lane within the point.
class SearchRandom {
  public:
    explicit SearchRandom(std::uint32_t stream) : stream_(stream) {}
    std::uint32_t word()
    {
        if (next_ == 4) {
            block_ = philox({static_cast<std::uint32_t>(counter_), static_cast<std::uint32_t>(counter_ >> 32), stream_, 0x5EA2C4u}, {0x4C52534Du, 0x65712E31u});
            ++counter_;
            next_ = 0;
        }
        return block_[next_++];
    }
    /// In [0, 1), 53 bits.
    double unit()
    {
        const std::uint64_t high = word() >> 5, low = word() >> 6;
        return static_cast<double>((high << 26) | low) * 0x1p-53;
    }
    float uniform(float low, float high) { return low + (high - low) * unitFloat(word()); }

  private:
    std::uint32_t stream_;
    std::uint64_t counter_ = 0;
    Philox4 block_{};
    std::size_t next_ = 4;
};

namespace detail {

template <class T>
T clampTo(const Axis<T>& axis, T x)
{
    const T low = axis.spacing == Spacing::signedLogarithmic ? -axis.high : axis.low;
    return std::min(std::max(x, low), axis.high);
}

/// The point at fraction u of an axis.
template <class T>
T alongAxis(const Axis<T>& axis, double u)
{
    if (axis.spacing == Spacing::linear) return clampTo(axis, static_cast<T>(double(axis.low) + (double(axis.high) - double(axis.low)) * u));
    const double span = std::log2(double(axis.high)) - std::log2(double(axis.low));  // their ratio may be beyond double
    if (axis.spacing == Spacing::logarithmic) return clampTo(axis, static_cast<T>(double(axis.low) * std::exp2(span * u)));
    const double half = 2.0 * (u < 0.5 ? 0.5 - u : u - 0.5), magnitude = double(axis.low) * std::exp2(span * half);
    return clampTo(axis, static_cast<T>(u < 0.5 ? -magnitude : magnitude));
}

}  // namespace detail

/// Largest error(input) over the space. `error` returns the error; NaN (the function failed) counts as infinite, a negative number says that
/// this input is not to be compared.
template <class T, std::size_t N, class Error>
Worst<T, N> findWorst(const SearchSpace<T, N>& space, const SearchBudget& budget, const Error& error, std::uint32_t stream = 0)
{
    using Point = std::array<T, N>;
    Worst<T, N> worst;
    const auto evaluate = [&](const Point& point) {
        const double e = error(point);
        ++worst.evaluations;
        const double seen = e != e ? std::numeric_limits<double>::infinity() : e;
        if (seen > worst.error) worst.error = seen, worst.input = point;
        return seen;
    };

    // Planted boundaries, and their neighbours along each axis.
    for (const Point& planted : space.planted)
        for (std::size_t axis = 0; axis < N; ++axis)
            for (const int ulps : {0, 1, -1, 2, -2, 3, -3, 7, -7, 64, -64}) {
                Point point = planted;
                point[axis] = detail::clampTo(space.axes[axis], moveByUlps(point[axis], ulps));
                evaluate(point);
            }

    // Sweep: stratified along the first axis, random along the others; the worst of each part is where a climb starts.
    constexpr std::uint64_t kParts = 32;
    std::array<Point, kParts> starts{};
    std::array<double, kParts> heights;
    heights.fill(-1.0);
    SearchRandom random(stream);
    for (std::uint64_t i = 0; i < budget.sweep; ++i) {
        Point point;
        for (std::size_t axis = 0; axis < N; ++axis) {
            const double u = random.unit();
            point[axis] = detail::alongAxis(space.axes[axis], axis == 0 ? (static_cast<double>(i) + u) / static_cast<double>(budget.sweep) : u);
        }
        const double e = evaluate(point);
        if (e < 0.0) continue;
        worst.sum += e;
        ++worst.swept;
        const std::size_t part = static_cast<std::size_t>(i * kParts / budget.sweep);
        if (e > heights[part]) heights[part] = e, starts[part] = point;
    }

    // Climbs, from each part's worst and last of all from the worst of all.
    const std::uint64_t steps = budget.climb / (kParts + 4);
    for (std::size_t part = 0; part <= kParts; ++part) {
        Point here = part < kParts ? starts[part] : worst.input;
        double height = part < kParts ? heights[part] : worst.error;
        if (height < 0.0) continue;
        for (std::uint64_t step = 0; step < (part < kParts ? steps : 4 * steps); ++step) {
            Point there = here;
            const std::uint32_t choice = random.word();
            for (std::size_t axis = 0; axis < N; ++axis) {
                if (N > 1 && !((choice >> axis) & 1u) && choice % N != axis) continue;
                const std::uint32_t move = random.word();
                constexpr std::uint32_t kLongest = sizeof(T) == 4 ? 22 : 50;
                const std::int64_t reach = std::int64_t(1) << ((move >> 8) % kLongest);
                const std::int64_t length = 1 + static_cast<std::int64_t>(random.word() % static_cast<std::uint32_t>(std::min<std::int64_t>(reach, 1 << 30)));
                there[axis] = detail::clampTo(space.axes[axis], moveByUlps(here[axis], (move & 1u) ? length : -length));
            }
            const double e = evaluate(there);
            if (e >= height) height = e, here = there;
        }
    }
    return worst;
}

/// error(i) for every i in [0, count): nothing is left out.
template <class Error>
Worst<double, 1> exhaust(std::uint64_t count, const Error& error, std::uint64_t stride = 1)
{
    Worst<double, 1> worst;
    for (std::uint64_t i = 0; i < count; i += stride) {
        const double e = error(i);
        ++worst.evaluations;
        if (e < 0.0) continue;
        const double seen = e != e ? std::numeric_limits<double>::infinity() : e;
        if (seen > worst.error) worst.error = seen, worst.input = {static_cast<double>(i)};
        worst.sum += seen;
        ++worst.swept;
    }
    return worst;
}

/// Digits that restore the bits.
inline std::string exactText(float x)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", static_cast<double>(x));
    return text;
}
inline std::string exactText(double x)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    return text;
}

/// "mu = 0.5, zc = 0.25"
template <class T, std::size_t N>
std::string inputText(const std::array<const char*, N>& names, const std::array<T, N>& input)
{
    std::string text;
    for (std::size_t i = 0; i < N; ++i) text += (i ? ", " : "") + std::string(names[i]) + " = " + exactText(input[i]);
    return text;
}

}  // namespace lrsm
