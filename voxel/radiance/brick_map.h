#pragma once

#include "core/base/formats.h"
#include "core/base/parallel.h"
#include "core/settings/settings.h"
#include "voxel/bit_grid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

/// Where texels of a volume are held: near surfaces, in bricks.
namespace lrsm {

/// One level, n^3 texels, in bricks of 4^3 that are held where the level's texels may be occupied; elsewhere every texel is 0. What is stored is what a dense
/// grid would store, to the bit. Brick 0 is all zero and stands for the absent ones.
struct BrickMap {
    int resolution = 0;                     ///< n
    std::vector<std::uint32_t> bricks;      ///< of each brick of the dense grid, x fastest: its place, or 0
    std::vector<std::uint32_t> coordinate;  ///< of each place: which brick of the dense grid

    static constexpr std::size_t kTexels = 64;
    int edge() const { return BitGrid::bricksPerEdge(resolution); }
    std::size_t texelCount() const { return coordinate.size() * kTexels; }
    std::size_t brickIndex(int x, int y, int z) const
    {
        const auto n = std::size_t(edge());
        return (std::size_t(z >> 2) * n + std::size_t(y >> 2)) * n + std::size_t(x >> 2);
    }
    /// Of a texel inside the level. One in an absent brick gives one of the zeros.
    std::size_t texel(int x, int y, int z) const { return bricks[brickIndex(x, y, z)] * kTexels + std::size_t(BitGrid::bitIndex(x, y, z)); }
    /// Where texel k of a place stands in the level; outside it where n is no multiple of 4.
    IVec3 texelOf(std::size_t place, int k) const;
    bool holds(const IVec3& texel) const { return texel.x < resolution && texel.y < resolution && texel.z < resolution; }
};

/// visit(texel, place in the arrays, task) for all texels of the level's held bricks, in parallel: tasks from 0 on, each of its own bricks whatever the
/// threads.
inline constexpr std::size_t kBricksPerTask = 64;
template <class Visit>
void forTexels(const BrickMap& map, const Visit& visit)
{
    parallelFor(map.coordinate.size(), kBricksPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t place = std::max<std::size_t>(begin, 1); place < end; ++place)
            for (int k = 0; k < int(BrickMap::kTexels); ++k)
                if (const IVec3 texel = map.texelOf(place, k); map.holds(texel))
                    visit(texel, place * BrickMap::kTexels + std::size_t(k), begin / kBricksPerTask);
    });
}

/// visit(texel, place in the arrays, counts): counts summed in the order of tasks.
template <class Visit>
void forCountedTexels(const BrickMap& map, ConversionCounts& total, const Visit& visit)
{
    std::vector<ConversionCounts> counts(map.coordinate.size() / kBricksPerTask + 1);
    forTexels(map, [&](const IVec3& texel, std::size_t at, std::size_t task) { visit(texel, at, counts[task]); });
    for (const ConversionCounts& task : counts) total += task;
}

/// The eight texels below one, by the level's parity: bit a of the index is the higher half along axis a.
using TexelChildren = std::array<std::size_t, 8>;
inline TexelChildren childrenOf(const BrickMap& below, const IVec3& texel)
{
    TexelChildren children;
    for (int k = 0; k < 8; ++k) children[std::size_t(k)] = below.texel(2 * texel.x + (k & 1), 2 * texel.y + ((k >> 1) & 1), 2 * texel.z + (k >> 2));
    return children;
}

/// The bricks of all levels: level l's are held where an occupied voxel lies within them.
std::vector<BrickMap> mapBricks(const BitGrid& bits);

/// What is held of a volume with `base` texels a place in level 0 and `above` in the others; and where every brick is held.
std::size_t predictBrickBytes(const std::vector<BrickMap>& maps, int base, int above);
std::size_t predictDenseBrickBytes(int resolution, int base, int above);

/// Bytes of a texture of one level on a GPU, dense: R16G16B16A16F.
std::size_t denseGpuBytes(int resolution);

/// As a texture of this storage holds it.
Vec4 storedTexel(const Vec4& value, Storage storage, HalfRounding rounding, ConversionCounts& counts);

}  // namespace lrsm
