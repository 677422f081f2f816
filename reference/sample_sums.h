#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// Sums of samples that do not depend on the order of addition, so that renders of sample ranges join exactly.
///
/// Every sample is rounded once to a multiple of 2^-48 of the scene's unit (see sampleUnit) and added as a 128-bit integer. The sum over
/// [A, C) therefore has the same bits whether it was rendered at once, after an interruption, or merged from [A, B) and [B, C). The
/// spread is taken over complete blocks of 2^blockBits samples (aligned to the absolute sample index; see sobol.h). A block that a range
/// cuts is kept aside until the rest of it arrives.
namespace lrsm {

__extension__ typedef __int128 Int128;

/// Half-open range of sample indices.
struct SampleRange {
    std::uint64_t begin = 0, end = 0;
    std::uint64_t size() const { return end - begin; }
    bool operator==(const SampleRange&) const = default;
};

/// The part of one block that has been rendered.
struct PartialBlock {
    std::uint64_t block = 0;
    std::uint32_t samples = 0;
    std::vector<Int128> sums;  ///< [pixel * channels + channel]
    bool operator==(const PartialBlock&) const = default;
};

struct SampleSums {
    int channels = 0;   ///< values a pixel
    int blockBits = 4;  ///< log2 of the samples in a block
    std::uint64_t completeBlocks = 0;
    std::vector<SampleRange> ranges;    ///< what the sums hold: ascending, disjoint, not touching
    std::vector<Int128> sums;           ///< of the complete blocks' samples, [pixel * channels + channel], unit * 2^-48
    std::vector<Int128> squares;        ///< of the complete blocks' means squared, unit^2 * 2^-60
    std::vector<PartialBlock> partial;  ///< ascending block

    std::uint64_t sampleCount() const;
    std::uint64_t blockSize() const { return std::uint64_t(1) << blockBits; }
    bool operator==(const SampleSums&) const = default;
};

SampleSums makeSums(std::size_t pixels, int channels, int blockBits);

/// Samples that a sum does not hold as they were.
struct SampleFaults {
    std::uint64_t notFinite = 0;  ///< NaN or infinite, counted as 0
    std::uint64_t clamped = 0;    ///< beyond +-2^24 of the scene's unit, counted as that
    SampleFaults& operator+=(const SampleFaults& other);
    bool operator==(const SampleFaults&) const = default;
};

/// A sample in units of the scene's unit to fixed point; what it cannot hold is counted in `faults`.
Int128 toFixed(double value, SampleFaults& faults);
/// Square of the mean of a complete block, given the sum of its samples.
Int128 squareOfBlockMean(Int128 blockSum, int blockBits);

/// Adds `other` to `sums`; cut blocks that become whole move to the complete ones. Both must have the same shape. Throws InputError where the
/// ranges overlap, naming `place`.
void mergeSums(SampleSums& sums, const SampleSums& other, const char* place);

/// Mean of all samples of one value, and variance of that mean, in the scene's unit.
struct Estimate {
    double mean = 0.0;
    double variance = 0.0;  ///< from the spread of the complete blocks' means; NaN with fewer than two
};
Estimate estimate(const SampleSums& sums, std::size_t index);

}  // namespace lrsm
