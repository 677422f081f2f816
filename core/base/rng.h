#pragma once

#include <array>
#include <cstdint>

/// Counter-based random numbers: a pure function of (key, counter), so that a sample's numbers depend on its pixel, index and dimension
/// and never on which thread drew what before.
namespace lrsm {

using Philox4 = std::array<std::uint32_t, 4>;

/// Philox4x32-10 of Salmon, Moraes, Dror and Shaw, "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011. Four independent words.
constexpr Philox4 philox(Philox4 counter, std::array<std::uint32_t, 2> key)
{
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t product0 = std::uint64_t(0xD2511F53u) * counter[0];
        const std::uint64_t product1 = std::uint64_t(0xCD9E8D57u) * counter[2];
        counter = {std::uint32_t(product1 >> 32) ^ counter[1] ^ key[0], std::uint32_t(product1), std::uint32_t(product0 >> 32) ^ counter[3] ^ key[1],
                   std::uint32_t(product0)};
        key[0] += 0x9E3779B9u;  // Weyl sequences of the golden ratio and sqrt(3) - 1
        key[1] += 0xBB67AE85u;
    }
    return counter;
}

/// The word's 24 high bits as a float in [0, 1): every value is exact, 1 is never reached.
constexpr float unitFloat(std::uint32_t word)
{
    return static_cast<float>(word >> 8) * 0x1p-24f;
}

}  // namespace lrsm
