#include "reference/checkpoint.h"
#include "reference/sample_sums.h"

#include "core/base/errors.h"
#include "core/base/rng.h"

#include "catch.h"

#include <cmath>
#include <limits>

using namespace lrsm;

/// The sums of samples [begin, end) of one pixel with two channels, added in any way that the interface allows.
static double sampleValue(std::uint64_t index, int channel)
{
    return double(unitFloat(philox({std::uint32_t(index), 0, 0, 0}, {1, 1})[std::size_t(channel)])) * (channel ? 1e-3 : 7.0);
}
static SampleSums sumsOf(SampleRange range)
{
    SampleSums sums = makeSums(1, 2, 3);
    SampleFaults faults;
    for (std::uint64_t block = range.begin / 8; block * 8 < range.end; ++block) {
        const std::uint64_t first = std::max(range.begin, block * 8), last = std::min(range.end, block * 8 + 8);
        std::vector<Int128> part(2, 0);
        for (std::uint64_t i = first; i < last; ++i)
            for (int c = 0; c < 2; ++c) part[std::size_t(c)] += toFixed(sampleValue(i, c), faults);
        if (last - first == 8) {
            for (std::size_t c = 0; c < 2; ++c) {
                sums.sums[c] += part[c];
                sums.squares[c] += squareOfBlockMean(part[c], 3);
            }
            ++sums.completeBlocks;
        } else {
            sums.partial.push_back({block, std::uint32_t(last - first), part});
        }
    }
    sums.ranges = {range};
    return sums;
}

TEST_CASE("ranges joined in any order give the bits of the whole, also where they cut a block twice", "[reference][sums]")
{
    const SampleSums whole = sumsOf({0, 100});
    const std::uint64_t a = GENERATE(1u, 8u, 33u), b = GENERATE(34u, 38u, 40u, 99u);
    SampleSums joined = sumsOf({a, b});
    mergeSums(joined, sumsOf({b, 100}), "test");
    mergeSums(joined, sumsOf({0, a}), "test");
    CHECK(joined == whole);
    CHECK(joined.ranges == std::vector<SampleRange>{{0, 100}});
}

TEST_CASE("what a sum cannot hold is counted: NaN and infinity as 0, beyond 2^24 as that", "[reference][sums]")
{
    SampleFaults faults;
    CHECK(toFixed(-0x1p24, faults) == -(Int128(1) << 72));
    CHECK(toFixed(0x1p-48, faults) == 1);
    CHECK(faults == SampleFaults{});
    CHECK(toFixed(std::nextafter(0x1p24, 1e9), faults) == Int128(1) << 72);
    CHECK(toFixed(-1e300, faults) == -(Int128(1) << 72));
    CHECK(toFixed(std::numeric_limits<double>::infinity(), faults) == 0);
    CHECK(toFixed(std::nan(""), faults) == 0);
    CHECK(faults == SampleFaults{.notFinite = 2, .clamped = 2});
    SampleFaults both = faults;
    both += faults;
    CHECK(both == SampleFaults{.notFinite = 4, .clamped = 4});
}

TEST_CASE("a gap stays visible and its blocks stay cut, an overlap is refused", "[reference][sums]")
{
    SampleSums sums = sumsOf({0, 20});
    mergeSums(sums, sumsOf({21, 40}), "test");
    CHECK(sums.ranges.size() == 2);
    CHECK(sums.partial.size() == 1);
    CHECK(sums.partial[0].samples == 7);
    CHECK(sums.sampleCount() == 39);
    CHECK_THROWS_AS(mergeSums(sums, sumsOf({19, 21}), "test"), InputError);
    CHECK_THROWS_AS(mergeSums(sums, sumsOf({0, 1}), "test"), InputError);
    mergeSums(sums, sumsOf({20, 21}), "test");
    CHECK(sums == sumsOf({0, 40}));
}

TEST_CASE("mean and variance of the mean agree with the textbook on the same samples", "[reference][sums]")
{
    const SampleSums sums = sumsOf({0, 80});
    for (int channel = 0; channel < 2; ++channel) {
        double mean = 0, squares = 0;
        for (std::uint64_t block = 0; block < 10; ++block) {
            double sum = 0;
            for (std::uint64_t i = 0; i < 8; ++i) sum += sampleValue(block * 8 + i, channel) / 8;
            mean += sum / 10;
            squares += sum * sum;
        }
        const Estimate e = estimate(sums, std::size_t(channel));
        CHECK(e.mean == Approx(mean).epsilon(1e-11));
        CHECK(e.variance == Approx((squares - 10 * mean * mean) / 9 / 10).epsilon(1e-8));
    }
    CHECK(std::isnan(estimate(sumsOf({0, 15}), 0).variance));
}

TEST_CASE("a checkpoint survives the way through its bytes, damage of any byte is found", "[reference][checkpoint]")
{
    Checkpoint checkpoint{{{"scene", "abc"}, {"size", "1x1"}}, 0.25, {}};
    checkpoint.state.target = {13, 100};
    checkpoint.state.sums = sumsOf({13, 60});
    checkpoint.state.sums.ranges.clear();
    checkpoint.state.base = sumsOf({0, 13});
    checkpoint.state.tileBlocks = {3, 2, 3};
    checkpoint.state.rays = {1, 2, 3};
    const std::vector<std::byte> bytes = encodeCheckpoint(checkpoint);
    std::vector<unsigned char> raw(bytes.size());
    std::transform(bytes.begin(), bytes.end(), raw.begin(), [](std::byte b) { return static_cast<unsigned char>(b); });

    const Checkpoint read = decodeCheckpoint(raw, "file");
    CHECK(read.identity == checkpoint.identity);
    CHECK(read.state.sums == checkpoint.state.sums);
    CHECK(read.state.base == checkpoint.state.base);
    CHECK(read.state.tileBlocks == checkpoint.state.tileBlocks);
    CHECK(read.state.target == checkpoint.state.target);
    CHECK(read.state.rays == checkpoint.state.rays);
    CHECK(encodeCheckpoint(read) == bytes);

    for (std::size_t i = 0; i < raw.size(); i += 7) {
        std::vector<unsigned char> damaged = raw;
        damaged[i] ^= 0x10;
        CHECK_THROWS_AS(decodeCheckpoint(damaged, "file"), InputError);
    }
    for (const std::size_t size : {std::size_t(0), std::size_t(3), raw.size() / 2, raw.size() - 1})
        CHECK_THROWS_AS(decodeCheckpoint({raw.begin(), raw.begin() + std::ptrdiff_t(size)}, "file"), InputError);
}

TEST_CASE("identities that differ are refused by the name of what differs", "[reference][checkpoint]")
{
    const Identity a = {{"scene", "1"}, {"seed", "0"}};
    CHECK_NOTHROW(requireSameIdentity(a, "a", a, "b"));
    for (const Identity& b : {Identity{{"scene", "1"}, {"seed", "2"}}, Identity{{"scene", "1"}}, Identity{{"scene", "1"}, {"seed", "0"}, {"more", "x"}}})
        CHECK_THROWS_AS(requireSameIdentity(a, "a", b, "b"), InputError);
    try {
        requireSameIdentity(a, "left", {{"scene", "1"}, {"seed", "2"}}, "right");
    } catch (const InputError& error) {
        CHECK(std::string(error.what()).find("seed") != std::string::npos);
    }
}
