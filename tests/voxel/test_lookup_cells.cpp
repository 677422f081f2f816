#include "voxel/lookup_cells.h"

#include "apps/validate/equations/synthetic_grids.h"

#include "catch.h"

#include <algorithm>

using namespace lrsm;

namespace {

bool mayHold(const LookupCells& cells, int resolution, int level, const IVec3& cell)
{
    const int n = std::max(resolution >> level, 1);
    const int bit = cells.firstBit[std::size_t(level)] + (((cell.z << LookupCells::edgeShift(n)) + cell.y) << LookupCells::rowShift(n)) + cell.x;
    return std::uint32_t(cells.words[std::size_t(bit / LookupCells::kWordBits)]) >> (bit % LookupCells::kWordBits) & 1u;
}

/// The definition: any voxel below the 2x2x2 texels from `cell` on.
bool anyVoxel(const BitGrid& bits, int level, const IVec3& cell)
{
    for (int z = cell.z << level; z < (cell.z + 2) << level; ++z)
        for (int y = cell.y << level; y < (cell.y + 2) << level; ++y)
            for (int x = cell.x << level; x < (cell.x + 2) << level; ++x)
                if (bits.occupied(x, y, z)) return true;
    return false;
}

}  // namespace

TEST_CASE("a cell's bit says whether any voxel is set below its eight texels", "[voxel][sampler][empty]")
{
    for (const int n : {1, 2, 4, 16, 128}) {
        for (const double voxels : {1.0, 30.0, 3000.0}) {  // the last reach cells at the ends of words
            const OpacityPyramid pyramid = pyramidOf(randomGrid(n, voxels / (double(n) * n * n), unsigned(n)), OpacityAxes::directional, Storage::gpu);
            const LookupCells cells(pyramid);
            const bool knowsNothing = std::all_of(pyramid.emptyLevels.begin(), pyramid.emptyLevels.end(), [](std::uint8_t levels) { return levels == 0; });
            int wrong = 0;
            for (int level = LookupCells::kFinest; level <= std::max(pyramid.levels() - 1, LookupCells::kFinest); ++level) {
                const int edge = std::max(n >> level, 1), stride = edge > 32 ? 3 : 1;
                for (int z = 0; z < edge; z += stride)
                    for (int y = 0; y < edge; y += stride)
                        for (int x = 0; x < edge; ++x)
                            wrong += mayHold(cells, n, level, {x, y, z}) != (knowsNothing || anyVoxel(pyramid.base, level, {x, y, z}));
            }
            INFO(n << "^3, about " << voxels << " voxels");
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("texels that do not follow from the voxels may be anywhere", "[voxel][sampler][empty]")
{
    OpacityPyramid pyramid = pyramidOf(randomGrid(16, 0.001, 5), OpacityAxes::directional, Storage::gpu);
    std::fill(pyramid.emptyLevels.begin(), pyramid.emptyLevels.end(), std::uint8_t(0));
    for (const std::int32_t word : LookupCells(pyramid).words) REQUIRE(word == -1);
}
