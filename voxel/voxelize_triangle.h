#pragma once

#include "voxel/bit_grid.h"
#include "voxel/fixed_triangle.h"
#include "voxel/span_walk.h"

#include <functional>

namespace lrsm {

/// How one triangle meets the grid. Columns run along the dominant axis of its normal, rows along `rowAxis`.
struct TriangleSetup {
    FixedTriangle triangle;
    std::array<std::int64_t, 3> normal{};  ///< in (1/4096 voxel)^2; turned so that the component along `depthAxis` is >= 0
    std::size_t columnAxis = 0, rowAxis = 1, depthAxis = 2;
    std::array<Span, 3> cells;  ///< touched along each axis, cut to the grid
    bool empty = true;          ///< touches no voxel
    bool boxIsExact = false;    ///< conservative: all of `cells` are touched, no test needed

    std::size_t columnCount() const
    {
        return std::size_t(cells[columnAxis].hi - cells[columnAxis].lo + 1) * std::size_t(cells[rowAxis].hi - cells[rowAxis].lo + 1);
    }
};

TriangleSetup setUpTriangle(const FixedTriangle& triangle, int resolution, Voxelization mode);

/// Sets the voxels of rows [rows.lo, rows.hi] (within cells[rowAxis]). May run concurrently on one grid: bits are set with relaxed
/// atomic ORs, which commute.
void voxelizeRows(const TriangleSetup& setup, Span rows, Voxelization mode, BitGrid& bits);

/// The same voxels, told instead of set: bit masks of bricks as in BitGrid, each voxel once. A brick may come several times.
using BrickVisitor = std::function<void(std::size_t brick, std::uint64_t mask)>;
void forEachBrick(const TriangleSetup& setup, Span rows, Voxelization mode, int resolution, const BrickVisitor& visit);

}  // namespace lrsm
