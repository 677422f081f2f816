#include "core/base/arrays.h"

#include "core/base/parallel.h"

#include <bit>

namespace lrsm {

std::uint64_t countNonFiniteFloats(const float* values, std::size_t count)
{
    constexpr std::size_t kGrain = std::size_t(1) << 18;
    constexpr std::uint32_t kExponent = 0x7f800000u;
    std::vector<std::uint64_t> partial((count + kGrain - 1) / kGrain, 0);
    parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
        std::uint32_t found = 0;
        for (std::size_t i = begin; i < end; ++i) found += (std::bit_cast<std::uint32_t>(values[i]) & kExponent) == kExponent ? 1u : 0u;
        partial[begin / kGrain] = found;
    });
    std::uint64_t total = 0;
    for (const std::uint64_t found : partial) total += found;
    return total;
}

}  // namespace lrsm
