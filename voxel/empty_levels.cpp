#include "voxel/empty_levels.h"

#include "core/base/parallel.h"

#include <algorithm>
#include <array>

namespace lrsm {
namespace {

/// One byte a cell: level 2 of the pyramid (bricks) and coarser.
struct CellGrid {
    int edge = 1;
    std::vector<std::uint8_t> cell;
    explicit CellGrid(int n) : edge(n), cell(std::size_t(n) * std::size_t(n) * std::size_t(n), 0) {}
    std::size_t index(int x, int y, int z) const { return (std::size_t(z) * std::size_t(edge) + std::size_t(y)) * std::size_t(edge) + std::size_t(x); }
};

template <class Body>
void forRows(int edge, const Body& body)
{
    const std::size_t rows = std::size_t(edge) * std::size_t(edge);
    parallelFor(rows, std::max<std::size_t>(1, 16384 / std::size_t(edge)), [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) body(int(row % std::size_t(edge)), int(row / std::size_t(edge)));
    });
}

CellGrid halve(const CellGrid& fine)
{
    CellGrid coarse(fine.edge / 2);
    forRows(coarse.edge, [&](int y, int z) {
        for (int x = 0; x < coarse.edge; ++x) {
            std::uint8_t any = 0;
            for (int k = 0; k < 8; ++k) any |= fine.cell[fine.index(2 * x + (k & 1), 2 * y + ((k >> 1) & 1), 2 * z + (k >> 2))];
            coarse.cell[coarse.index(x, y, z)] = any;
        }
    });
    return coarse;
}

/// OR over the 3x3x3 neighbourhood, one axis after the other.
CellGrid dilate(CellGrid bits)
{
    const std::size_t edge = std::size_t(bits.edge);
    for (const std::size_t stride : {std::size_t(1), edge, edge * edge}) {
        CellGrid wider(bits.edge);
        forRows(bits.edge, [&](int y, int z) {
            for (int x = 0; x < bits.edge; ++x) {
                const std::size_t i = bits.index(x, y, z);
                const int along = stride == 1 ? x : stride == edge ? y : z;
                std::uint8_t any = bits.cell[i];
                if (along > 0) any |= bits.cell[i - stride];
                if (along + 1 < bits.edge) any |= bits.cell[i + stride];
                wider.cell[i] = any;
            }
        });
        bits = std::move(wider);
    }
    return bits;
}

/// Bits of the neighbour at offset (dx, dy, dz) that lie within `reach` voxels of the brick.
std::uint64_t reachedBits(int dx, int dy, int dz, int reach)
{
    const auto inReach = [reach](int d, int i) { return d == 0 || (d < 0 ? i >= 4 - reach : i < reach); };
    std::uint64_t mask = 0;
    for (int bit = 0; bit < 64; ++bit)
        if (inReach(dx, bit & 3) && inReach(dy, (bit >> 2) & 3) && inReach(dz, bit >> 4)) mask |= std::uint64_t(1) << bit;
    return mask;
}

struct Neighbours {
    std::array<std::array<std::uint64_t, 27>, 2> mask;  ///< [reach - 1][(dz + 1) * 9 + (dy + 1) * 3 + dx + 1]
    Neighbours()
    {
        for (int reach = 1; reach <= 2; ++reach)
            for (int k = 0; k < 27; ++k) mask[std::size_t(reach - 1)][std::size_t(k)] = reachedBits(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1, reach);
    }
};

/// Levels 0 and 1 read 1 and 2 voxels beyond the brick.
std::uint8_t fineEmptyLevels(const BitGrid& base, const Neighbours& neighbours, int bx, int by, int bz)
{
    const int edge = BitGrid::bricksPerEdge(base.grid.resolution);
    std::uint64_t near = 0, far = 0;
    for (int k = 0; k < 27; ++k) {
        const int x = bx + k % 3 - 1, y = by + k / 3 % 3 - 1, z = bz + k / 9 - 1;
        if (x < 0 || y < 0 || z < 0 || x >= edge || y >= edge || z >= edge) continue;
        const std::uint64_t brick = base.bricks[base.brickIndex(4 * x, 4 * y, 4 * z)];
        near |= brick & neighbours.mask[0][std::size_t(k)];
        far |= brick & neighbours.mask[1][std::size_t(k)];
        if (near != 0) return 0;
    }
    return far != 0 ? 1 : 2;
}

}  // namespace

std::vector<std::uint8_t> findEmptyLevels(const BitGrid& base)
{
    const int edge = BitGrid::bricksPerEdge(base.grid.resolution);
    std::vector<CellGrid> occupied;
    occupied.emplace_back(edge);
    forRows(edge, [&](int y, int z) {
        for (int x = 0; x < edge; ++x) {
            const std::size_t i = occupied[0].index(x, y, z);
            occupied[0].cell[i] = base.bricks[i] != 0;
        }
    });
    while (occupied.back().edge > 1) occupied.push_back(halve(occupied.back()));

    // From the coarsest level down: a cell keeps what its parent knows, or finds out for its own level.
    const Neighbours neighbours;
    CellGrid parent(1);
    for (int c = int(occupied.size()) - 1; c >= 0; --c) {
        const bool finest = c == 0;
        CellGrid empty = dilate(std::move(occupied[std::size_t(c)]));
        forRows(empty.edge, [&](int y, int z) {
            for (int x = 0; x < empty.edge; ++x) {
                std::uint8_t& cell = empty.cell[empty.index(x, y, z)];
                if (cell == 0)
                    cell = std::max(std::uint8_t(c + 3),
                                    parent.cell[parent.index(x * parent.edge / empty.edge, y * parent.edge / empty.edge, z * parent.edge / empty.edge)]);
                else
                    cell = finest ? fineEmptyLevels(base, neighbours, x, y, z) : std::uint8_t(0);
            }
        });
        parent = std::move(empty);
    }
    return std::move(parent.cell);
}

}  // namespace lrsm
