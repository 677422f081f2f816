#pragma once

#include <cstddef>
#include <span>

namespace lrsm {

/// How many of the ascending `values` are at most x: std::upper_bound without a branch on a value. Where x is random, a processor would guess half of them
/// wrong, and searches side by side could not overlap.
template <class T>
std::size_t countUpTo(std::span<const T> values, T x)
{
    if (values.empty()) return 0;
    const T* from = values.data();
    for (std::size_t left = values.size(); left > 1;) {
        const std::size_t half = left / 2;
        from += half & (0 - std::size_t(from[half - 1] <= x));
        left -= half;
    }
    return std::size_t(from - values.data()) + std::size_t(*from <= x);
}

}  // namespace lrsm
