#include "reference/sample_sums.h"

#include "core/base/errors.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

namespace lrsm {
namespace {

constexpr double kSampleScale = 0x1p48;
constexpr double kSquareScale = 0x1p60;
constexpr double kExactIn64Bits = 0x1p62;
constexpr double kLargestSample = 0x1p24;  // its square, scaled, is 2^108: 2^19 such blocks fit a sum

std::string describe(const SampleRange& range)
{
    return std::to_string(range.begin) + ":" + std::to_string(range.end);
}

/// Union of two ascending lists of disjoint ranges.
std::vector<SampleRange> joinRanges(const std::vector<SampleRange>& a, const std::vector<SampleRange>& b, const char* place)
{
    std::vector<SampleRange> all(a);
    all.insert(all.end(), b.begin(), b.end());
    std::sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.begin < y.begin; });
    std::vector<SampleRange> joined;
    for (const SampleRange& range : all) {
        if (!joined.empty() && range.begin < joined.back().end)
            throw InputError(place, "samples " + describe(range) + " overlap samples " + describe(joined.back()) + "; each sample may be counted once");
        if (!joined.empty() && range.begin == joined.back().end)
            joined.back().end = range.end;
        else
            joined.push_back(range);
    }
    return joined;
}

/// Moves a cut block that has become whole to the complete ones.
void complete(SampleSums& sums, const PartialBlock& block)
{
    for (std::size_t i = 0; i < sums.sums.size(); ++i) {
        sums.sums[i] += block.sums[i];
        sums.squares[i] += squareOfBlockMean(block.sums[i], sums.blockBits);
    }
    ++sums.completeBlocks;
}

}  // namespace

std::uint64_t SampleSums::sampleCount() const
{
    std::uint64_t count = 0;
    for (const SampleRange& range : ranges) count += range.size();
    return count;
}

SampleSums makeSums(std::size_t pixels, int channels, int blockBits)
{
    SampleSums result;
    result.channels = channels;
    result.blockBits = blockBits;
    result.sums.assign(pixels * std::size_t(channels), 0);
    result.squares.assign(pixels * std::size_t(channels), 0);
    return result;
}

SampleFaults& SampleFaults::operator+=(const SampleFaults& other)
{
    notFinite += other.notFinite;
    clamped += other.clamped;
    return *this;
}

Int128 toFixed(double value, SampleFaults& faults)
{
    if (!std::isfinite(value)) {
        ++faults.notFinite;
        return 0;
    }
    const double scaled = value * kSampleScale;
    if (std::abs(scaled) < kExactIn64Bits) return static_cast<std::int64_t>(std::nearbyint(scaled));  // a 128-bit conversion is a call
    if (std::abs(value) > kLargestSample) ++faults.clamped;
    return static_cast<Int128>(std::nearbyint(std::clamp(value, -kLargestSample, kLargestSample) * kSampleScale));
}

Int128 squareOfBlockMean(Int128 blockSum, int blockBits)
{
    const double mean = std::ldexp(static_cast<double>(blockSum) / kSampleScale, -blockBits);
    return static_cast<Int128>(std::nearbyint(mean * mean * kSquareScale));
}

void mergeSums(SampleSums& sums, const SampleSums& other, const char* place)
{
    assert(sums.channels == other.channels && sums.blockBits == other.blockBits && sums.sums.size() == other.sums.size());
    sums.ranges = joinRanges(sums.ranges, other.ranges, place);
    for (std::size_t i = 0; i < sums.sums.size(); ++i) {
        sums.sums[i] += other.sums[i];
        sums.squares[i] += other.squares[i];
    }
    sums.completeBlocks += other.completeBlocks;

    for (const PartialBlock& block : other.partial) {
        const auto here =
            std::lower_bound(sums.partial.begin(), sums.partial.end(), block.block, [](const PartialBlock& p, std::uint64_t b) { return p.block < b; });
        if (here == sums.partial.end() || here->block != block.block) {
            sums.partial.insert(here, block);
            continue;
        }
        for (std::size_t i = 0; i < here->sums.size(); ++i) here->sums[i] += block.sums[i];
        here->samples += block.samples;
        if (here->samples == sums.blockSize()) {
            complete(sums, *here);
            sums.partial.erase(here);
        }
    }
}

Estimate estimate(const SampleSums& sums, std::size_t index)
{
    Estimate result;
    Int128 total = sums.sums[index];
    for (const PartialBlock& block : sums.partial) total += block.sums[index];
    const auto count = static_cast<double>(sums.sampleCount());
    result.mean = static_cast<double>(total) / kSampleScale / count;

    result.variance = std::numeric_limits<double>::quiet_NaN();
    if (sums.completeBlocks >= 2) {
        const auto blocks = static_cast<double>(sums.completeBlocks);
        const double mean = std::ldexp(static_cast<double>(sums.sums[index]) / kSampleScale, -sums.blockBits) / blocks;
        const double square = static_cast<double>(sums.squares[index]) / kSquareScale / blocks;
        const double ofBlock = std::max(0.0, square - mean * mean) * blocks / (blocks - 1.0);
        result.variance = ofBlock * static_cast<double>(sums.blockSize()) / count;
    }
    return result;
}

}  // namespace lrsm
