#include "voxel/pyramid_levels.h"

#include "core/base/parallel.h"

#include <algorithm>
#include <bit>

namespace lrsm {
namespace {

constexpr std::size_t kTexelsPerTask = 16384;

/// body(z) for every slice of a grid of n^3.
template <class Body>
void forSlices(int n, const Body& body)
{
    const std::size_t perSlice = std::size_t(n) * std::size_t(n);
    parallelFor(std::size_t(n), std::max<std::size_t>(1, kTexelsPerTask / perSlice), [&](std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) body(int(z));
    });
}

// --- Values: what a fraction and a filter's result become in storage. ---

void store(std::uint8_t& texel, int numerator, int log2Denominator)
{
    const int half = (1 << log2Denominator) >> 1;
    texel = std::uint8_t(std::min(255, (numerator * 255 + half) >> log2Denominator));
}
void store(float& texel, int numerator, int log2Denominator)
{
    texel = std::min(1.0f, float(numerator) / float(1 << log2Denominator));
}

template <MipFilter filter>
std::uint8_t combine(const std::uint8_t (&c)[8])
{
    if constexpr (filter == MipFilter::max) return *std::max_element(c, c + 8);
    const int sum = c[0] + c[1] + c[2] + c[3] + c[4] + c[5] + c[6] + c[7];
    if constexpr (filter == MipFilter::mean) return std::uint8_t((sum + 4) >> 3);
    return std::uint8_t(std::min(255, (sum + 2) >> 2));
}
template <MipFilter filter>
float combine(const float (&c)[8])
{
    if constexpr (filter == MipFilter::max) return *std::max_element(c, c + 8);
    const float sum = ((c[0] + c[1]) + (c[2] + c[3])) + ((c[4] + c[5]) + (c[6] + c[7]));
    if constexpr (filter == MipFilter::mean) return sum * 0.125f;
    return std::min(1.0f, sum * 0.25f);
}

// --- Bits: counting within a brick, bit x + 4 y + 16 z. ---

/// Set bits in each of the eight 2x2x2 blocks of a brick.
struct BlockCounts {
    std::uint64_t half[2];  ///< blocks at x = 0 and x = 2
    explicit BlockCounts(std::uint64_t brick)
    {
        const std::uint64_t pairs = brick - ((brick >> 1) & 0x5555555555555555u);
        for (int dx = 0; dx < 2; ++dx) {
            std::uint64_t c = (pairs >> (2 * dx)) & 0x3333333333333333u;
            c = (c + (c >> 4)) & 0x0F0F0F0F0F0F0F0Fu;
            half[dx] = c + (c >> 16);
        }
    }
    int at(int dx, int dy, int dz) const { return int(half[dx] >> (8 * dy + 32 * dz)) & 15; }
};

/// The 2-voxel columns of the 2x2x2 blocks along an axis: their OR stays at the lower voxel of the column.
std::uint64_t orPairs(std::uint64_t brick, int axis)
{
    if (axis == 0) return (brick | (brick >> 1)) & 0x5555555555555555u;
    if (axis == 1) return (brick | (brick >> 4)) & 0x0F0F0F0F0F0F0F0Fu;
    return (brick | (brick >> 16)) & 0x0000FFFF0000FFFFu;
}

/// The 16 columns of a whole brick along an axis, one bit each.
std::uint64_t orColumns(std::uint64_t brick, int axis)
{
    const int stride = 1 << (2 * axis);
    brick |= brick >> (2 * stride);
    brick |= brick >> stride;
    constexpr std::uint64_t first[3] = {0x1111111111111111u, 0x000F000F000F000Fu, 0x000000000000FFFFu};
    return brick & first[axis];
}

template <class Texel>
struct Levels {
    OpacityPyramid& pyramid;
    Texel* texels;
    int channels = pyramid.channels();
    Texel* at(int level, int x, int y, int z) const { return texels + pyramid.texelIndex(level, x, y, z) * std::size_t(channels); }
};

/// Level 1 of one brick: its eight 2x2x2 blocks.
template <class Texel>
void fillBlocks(const Levels<Texel>& out, std::uint64_t brick, int bx, int by, int bz)
{
    const int blocks = std::min(2, out.pyramid.resolutionAt(1));
    const bool directional = out.channels == 3;
    const MipFilter filter = out.pyramid.mipFilter;
    for (int c = 0; c < out.channels; ++c) {
        const BlockCounts counts(directional ? orPairs(brick, c) : brick);
        for (int dz = 0; dz < blocks; ++dz) {
            for (int dy = 0; dy < blocks; ++dy) {
                for (int dx = 0; dx < blocks; ++dx) {
                    const int count = counts.at(dx, dy, dz);
                    Texel& texel = out.at(1, 2 * bx + dx, 2 * by + dy, 2 * bz + dz)[c];
                    if (directional || filter == MipFilter::coverage)
                        store(texel, count, 2);
                    else if (filter == MipFilter::mean)
                        store(texel, count, 3);
                    else
                        store(texel, count != 0, 0);
                }
            }
        }
    }
}

/// Directional level 3 of 2x2x2 bricks.
template <class Texel>
void fillEightBricks(const Levels<Texel>& out, int x, int y, int z)
{
    const BitGrid& base = out.pyramid.base;
    std::uint64_t brick[8];
    std::uint64_t any = 0;
    for (int k = 0; k < 8; ++k) any |= brick[k] = base.bricks[base.brickIndex(8 * x + 4 * (k & 1), 8 * y + 4 * ((k >> 1) & 1), 8 * z + 4 * (k >> 2))];
    if (any == 0) return;
    for (int axis = 0; axis < 3; ++axis) {
        const int along = 1 << axis, side = 1 << ((axis + 1) % 3), other = 1 << ((axis + 2) % 3);
        int columns = 0;
        for (const int k : {0, side, other, side + other}) columns += std::popcount(orColumns(brick[k] | brick[k + along], axis));
        store(out.at(3, x, y, z)[axis], columns, 6);
    }
}

template <class Texel>
void fillFromBits(OpacityPyramid& pyramid, Texel* texels)
{
    const Levels<Texel> out{pyramid, texels};
    const BitGrid& base = pyramid.base;
    const int edge = BitGrid::bricksPerEdge(base.grid.resolution);
    forSlices(edge, [&](int bz) {
        std::size_t index = std::size_t(bz) * std::size_t(edge) * std::size_t(edge);
        for (int by = 0; by < edge; ++by) {
            for (int bx = 0; bx < edge; ++bx) {
                const std::uint64_t brick = base.bricks[index++];
                if (brick == 0) continue;
                fillBlocks(out, brick, bx, by, bz);
                if (out.channels == 3 && pyramid.levels() > 2)
                    for (int axis = 0; axis < 3; ++axis) store(out.at(2, bx, by, bz)[axis], std::popcount(orColumns(brick, axis)), 4);
            }
        }
    });
    if (out.channels == 3 && pyramid.levels() > 3) {
        const int n = pyramid.resolutionAt(3);
        forSlices(n, [&](int z) {
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) fillEightBricks(out, x, y, z);
        });
    }
}

template <int channels, MipFilter filter, class Texel>
void fillSlices(const Levels<Texel>& level, int l)
{
    const int n = level.pyramid.resolutionAt(l);
    forSlices(n, [&](int z) {
        for (int y = 0; y < n; ++y) {
            const Texel* row[4];
            for (int k = 0; k < 4; ++k) row[k] = level.at(l - 1, 0, 2 * y + (k & 1), 2 * z + (k >> 1));
            Texel* to = level.at(l, 0, y, z);
            for (int x = 0; x < n * channels; x += channels) {
                for (int c = 0; c < channels; ++c) {
                    const int i = 2 * x + c, j = i + channels;
                    const Texel child[8] = {row[0][i], row[0][j], row[1][i], row[1][j], row[2][i], row[2][j], row[3][i], row[3][j]};
                    to[x + c] = combine<filter>(child);
                }
            }
        }
    });
}

template <class Texel>
void fillFromBelow(OpacityPyramid& pyramid, Texel* texels, int level)
{
    const Levels<Texel> levels{pyramid, texels};
    const auto withFilter = [&]<int channels>() {
        switch (pyramid.mipFilter) {
        case MipFilter::mean: return fillSlices<channels, MipFilter::mean>(levels, level);
        case MipFilter::coverage: return fillSlices<channels, MipFilter::coverage>(levels, level);
        case MipFilter::max: return fillSlices<channels, MipFilter::max>(levels, level);
        }
    };
    if (levels.channels == 3)
        withFilter.template operator()<3>();
    else
        withFilter.template operator()<1>();
}

}  // namespace

void fillLevelsFromBits(OpacityPyramid& pyramid)
{
    if (pyramid.storage == Storage::gpu)
        fillFromBits(pyramid, pyramid.unorm8.data());
    else
        fillFromBits(pyramid, pyramid.float32.data());
}

void fillLevelFromBelow(OpacityPyramid& pyramid, int level)
{
    if (pyramid.storage == Storage::gpu)
        fillFromBelow(pyramid, pyramid.unorm8.data(), level);
    else
        fillFromBelow(pyramid, pyramid.float32.data(), level);
}

}  // namespace lrsm
