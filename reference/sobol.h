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
    x = __builtin_bswap32(x);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/// Nested uniform scrambling by hash (Laine and Karras 2011; Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020): a
/// multiplication by an even number carries only upwards, so with the bits reversed each bit is flipped by a hash of those above it.
constexpr std::uint32_t scrambleReversed(std::uint32_t x, std::uint32_t seed)
{
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

/// Sobol's second dimension, its bits reversed: bit k of the index stands for (1 + s)^k over GF(2), bit k of the result for s^k, so that the index is a
/// polynomial and this is its shift by one. (p + s^n q)(s + 1) = (p + q)(s + 1) + s^n q(s + 1) for n a power of two: half by half, all at once.
constexpr std::uint32_t secondReversed(std::uint32_t index)
{
    index ^= index >> 16;
    index ^= (index & 0xff00ff00u) >> 8;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xccccccccu) >> 2;
    return index ^ (index & 0xaaaaaaaau) >> 1;
}

/// Two dimensions of one block. Blocks with different seeds are independent, also where they are used side by side for more than two
/// dimensions: the order of the points is scrambled too.
class SobolBlock {
  public:
    /// \param seeds      from philox(), one call for each (pixel, block, dimension pair)
    /// \param blockBits  m: the block has 2^m points, m in [0, 16]
    SobolBlock(const Philox4& seeds, int blockBits) : seeds_(seeds), shift_(32 - blockBits) {}

    /// Point `index` in [0, 2^m).
    UnitPoint point(std::uint32_t index) const { return {first(index), unitFloat(reverseBits(scrambleReversed(secondReversed(scrambled(index)), seeds_[1])))}; }
    /// Its first coordinate.
    float first(std::uint32_t index) const { return unitFloat(reverseBits(scrambleReversed(scrambled(index), seeds_[0]))); }

  private:
    std::uint32_t scrambled(std::uint32_t index) const
    {
        return shift_ < 32 ? reverseBits(scrambleReversed(reverseBits(index << shift_), seeds_[2])) >> shift_ : index;
    }

    Philox4 seeds_;
    int shift_;
};

}  // namespace lrsm
