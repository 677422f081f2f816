#pragma once

#include "core/base/rng.h"

#include <cstdint>

/// Owen-scrambled Sobol points, two dimensions at a time, in blocks of 2^m points.
///
/// Each block is an independently scrambled (0, m, 2)-net: its points are stratified against each other (4 x 4 strata for 16 points),
/// and every point on its own is uniform, so the mean over any set of blocks is unbiased. Because blocks are independent and alike,
/// the spread of their means says how far the picture's mean may be off: the plain sample variance would overestimate it.
namespace lrsm {

struct UnitPoint {
    float u = 0.0f, v = 0.0f;  ///< [0, 1)
};

constexpr std::uint32_t reverseBits(std::uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/// Nested uniform scrambling by hash (Laine and Karras 2011; Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020): a
/// multiplication by an even number carries only upwards, so with the bits reversed each bit is flipped by a hash of those above it.
constexpr std::uint32_t owenScramble(std::uint32_t x, std::uint32_t seed)
{
    x = reverseBits(x);
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return reverseBits(x);
}

/// Two dimensions of one block. Blocks with different seeds are independent, also where they are used side by side for more than two
/// dimensions: the order of the points is scrambled too.
class SobolBlock {
  public:
    /// \param seeds      from philox(), one call for each (pixel, block, dimension pair)
    /// \param blockBits  m: the block has 2^m points, m in [0, 16]
    SobolBlock(const Philox4& seeds, int blockBits) : seeds_(seeds), shift_(32 - blockBits) {}

    /// Point `index` in [0, 2^m).
    UnitPoint point(std::uint32_t index) const
    {
        if (shift_ < 32) index = owenScramble(index << shift_, seeds_[2]) >> shift_;
        std::uint32_t second = 0;
        for (std::uint32_t column = 0x80000000u, rest = index; rest != 0; rest >>= 1, column ^= column >> 1)
            if (rest & 1u) second ^= column;
        return {unitFloat(owenScramble(reverseBits(index), seeds_[0])), unitFloat(owenScramble(second, seeds_[1]))};
    }

  private:
    Philox4 seeds_;
    int shift_;
};

}  // namespace lrsm
