#include "reference/sobol.h"

#include "catch.h"

#include <set>

using namespace lrsm;

static SobolBlock blockOf(std::uint32_t number, int bits)
{
    return {philox({number, 0, 0, 0}, {7, 8}), bits};
}

TEST_CASE("a block of 2^m points puts one into each elementary interval of its size", "[reference][sobol]")
{
    const int bits = GENERATE(0, 1, 4, 5, 8);
    const std::uint32_t count = 1u << bits;
    for (std::uint32_t number = 0; number < 20; ++number) {
        const SobolBlock block = blockOf(number, bits);
        for (int split = 0; split <= bits; ++split) {  // 2^split columns times 2^(bits - split) rows
            std::set<std::pair<int, int>> cells;
            for (std::uint32_t i = 0; i < count; ++i) {
                const UnitPoint p = block.point(i);
                REQUIRE((p.u >= 0 && p.u < 1 && p.v >= 0 && p.v < 1));
                cells.insert({int(p.u * float(1 << split)), int(p.v * float(1 << (bits - split)))});
            }
            REQUIRE(cells.size() == count);
        }
    }
}

TEST_CASE("Sobol's second dimension is that of its direction numbers", "[reference][sobol]")
{
    // Bratley and Fox, ACM TOMS 659: v_1 = 1/2, v_(i+1) = v_i xor v_i / 2, for each bit of the index from the lowest on.
    for (std::uint32_t index = 0; index < 1u << 18; ++index) {
        std::uint32_t second = 0;
        for (std::uint32_t number = 0x80000000u, rest = index; rest != 0; rest >>= 1, number ^= number >> 1)
            if (rest & 1u) second ^= number;
        REQUIRE(reverseBits(secondReversed(index)) == second);
    }
    for (std::uint32_t i = 0; i < 32; ++i) CHECK(blockOf(3, 5).first(i) == blockOf(3, 5).point(i).u);
}

TEST_CASE("each point of a block alone is uniform, also the first and the last", "[reference][sobol]")
{
    // Chi-squared over 8 x 8 cells of 64000 blocks' points: 63 degrees of freedom; 140 is passed by chance once in 10^7 (three tests).
    const std::uint32_t index = GENERATE(0u, 6u, 15u);
    std::array<int, 64> counts{};
    constexpr int blocks = 64000;
    for (std::uint32_t number = 0; number < blocks; ++number) {
        const UnitPoint p = blockOf(number, 4).point(index);
        ++counts[std::size_t(int(p.u * 8) * 8 + int(p.v * 8))];
    }
    double chi2 = 0;
    for (const int n : counts) chi2 += (n - 1000.0) * (n - 1000.0) / 1000.0;
    CHECK(chi2 < 140.0);
}

TEST_CASE("dimensions of two blocks side by side do not go together", "[reference][sobol]")
{
    // Sum over blocks and points of (u - 1/2)(u' - 1/2), u and u' of two pairs: mean 0, variance of a term 1/144. 6 standard errors: 2e-9. A
    // common order of the points would leave the blocks' terms correlated: the spread of the block sums is checked too.
    double sum = 0, squares = 0;
    constexpr std::uint32_t blocks = 20000;
    for (std::uint32_t number = 0; number < blocks; ++number) {
        const SobolBlock a = blockOf(2 * number, 4), b = blockOf(2 * number + 1, 4);
        double block = 0;
        for (std::uint32_t i = 0; i < 16; ++i) block += (double(a.point(i).u) - 0.5) * (double(b.point(i).u) - 0.5);
        sum += block;
        squares += block * block;
    }
    const double independent = 16.0 / 144.0;  // variance of a block's sum if the 16 terms were independent
    CHECK(std::abs(sum) < 6.0 * std::sqrt(blocks * independent) * 1.5);
    CHECK(squares / blocks < 2.0 * independent);
}
