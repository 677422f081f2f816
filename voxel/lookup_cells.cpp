#include "voxel/lookup_cells.h"

#include "core/base/parallel.h"

#include <algorithm>
#include <span>

namespace lrsm {
namespace {

/// A bit a texel of one level, n texels along an edge.
struct TexelBits {
    int n;
    std::size_t rowWords;
    std::vector<std::uint32_t> words;
    explicit TexelBits(int edge)
        : n(edge),
          rowWords((std::size_t(1) << LookupCells::rowShift(edge)) / LookupCells::kWordBits),
          words(std::size_t(edge) * std::size_t(edge) * rowWords, 0)
    {
    }
    std::uint32_t* row(int y, int z) { return words.data() + (std::size_t(z) * std::size_t(n) + std::size_t(y)) * rowWords; }
    const std::uint32_t* row(int y, int z) const { return const_cast<TexelBits*>(this)->row(y, z); }
};

template <class Body>
void forPlanes(int n, const Body& body)
{
    parallelFor(std::size_t(n), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) body(int(z));
    });
}

/// Bit i: bit 2i or 2i + 1 of `bits`.
std::uint32_t halveBits(std::uint32_t bits)
{
    bits = (bits | bits >> 1) & 0x55555555u;
    bits = (bits | bits >> 1) & 0x33333333u;
    bits = (bits | bits >> 2) & 0x0f0f0f0fu;
    bits = (bits | bits >> 4) & 0x00ff00ffu;
    return (bits | bits >> 8) & 0x0000ffffu;
}

/// Level 1: which 2x2x2 voxels hold any.
TexelBits halve(const BitGrid& base)
{
    TexelBits out(std::max(base.grid.resolution / 2, 1));
    const int bricks = BitGrid::bricksPerEdge(base.grid.resolution);
    forPlanes(out.n, [&](int z) {
        for (int by = 0; by < bricks; ++by)
            for (int bx = 0; bx < bricks; ++bx) {
                const std::uint64_t brick = base.bricks[base.brickIndex(4 * bx, 4 * by, 2 * z)];
                if (brick == 0) continue;
                const auto half = std::uint32_t(brick >> (z & 1 ? 32 : 0));
                const std::uint32_t rows = (half | half >> 16) & 0xffffu, pairs = rows | rows >> 4;
                for (int y = 2 * by; y < std::min(2 * by + 2, out.n); ++y)
                    out.row(y, z)[2 * bx / LookupCells::kWordBits] |= halveBits(pairs >> (y & 1 ? 8 : 0) & 15u) << (2 * bx % LookupCells::kWordBits);
            }
    });
    return out;
}

TexelBits halve(const TexelBits& fine)
{
    TexelBits out(fine.n / 2);
    forPlanes(out.n, [&](int z) {
        for (int y = 0; y < out.n; ++y) {
            std::uint32_t* to = out.row(y, z);
            for (std::size_t i = 0; i < fine.rowWords; ++i) {
                const auto at = [&](int dy, int dz) { return fine.row(2 * y + dy, 2 * z + dz)[i]; };
                to[i / 2] |= halveBits(at(0, 0) | at(1, 0) | at(0, 1) | at(1, 1)) << (i % 2 * 16);
            }
        }
    });
    return out;
}

/// Texels to cells: with the next one along each axis, where there is one.
void fillCells(std::span<std::int32_t> cells, const TexelBits& texels)
{
    forPlanes(texels.n, [&](int z) {
        const int zNext = std::min(z + 1, texels.n - 1);
        for (int y = 0; y < texels.n; ++y) {
            const int yNext = std::min(y + 1, texels.n - 1);
            const auto at = [&](std::size_t i) {
                return texels.row(y, z)[i] | texels.row(yNext, z)[i] | texels.row(y, zNext)[i] | texels.row(yNext, zNext)[i];
            };
            std::int32_t* to = cells.data() + (texels.row(y, z) - texels.words.data());
            std::uint32_t here = at(0);
            for (std::size_t i = 0; i < texels.rowWords; ++i) {
                const std::uint32_t next = i + 1 < texels.rowWords ? at(i + 1) : 0;
                to[i] = static_cast<std::int32_t>(here | here >> 1 | next << (LookupCells::kWordBits - 1));
                here = next;
            }
        }
    });
}

}  // namespace

LookupCells::LookupCells(const OpacityPyramid& pyramid)
{
    const int resolution = pyramid.base.grid.resolution, topLevel = std::max(pyramid.levels() - 1, kFinest);
    std::vector<std::size_t> firstWord;
    std::size_t count = 0;
    for (int level = kFinest; level <= topLevel; ++level) {
        const int n = std::max(resolution >> level, 1);
        firstBit[std::size_t(level)] = static_cast<std::int32_t>(count * kWordBits);
        firstWord.push_back(count);
        count += (std::size_t(n) * std::size_t(n) << rowShift(n)) / kWordBits;
    }
    // Texels that another program wrote need not follow from the voxels: such a pyramid knows of no empty place.
    if (std::all_of(pyramid.emptyLevels.begin(), pyramid.emptyLevels.end(), [](std::uint8_t levels) { return levels == 0; })) {
        words.assign(count, ~std::int32_t(0));
        return;
    }
    words.resize(count);
    TexelBits texels = halve(pyramid.base);
    for (std::size_t level = 0; level < firstWord.size(); ++level) {
        if (level > 0) texels = halve(texels);
        fillCells(std::span(words).subspan(firstWord[level], texels.words.size()), texels);
    }
}

}  // namespace lrsm
