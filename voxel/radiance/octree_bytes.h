#pragma once

#include "voxel/bit_grid.h"

#include <cstddef>
#include <vector>

/// What an octree over the same voxels would take, counted, not built: to judge the dense grid's size by.
namespace lrsm {

/// Occupied texels of each level, the voxels first.
std::vector<std::size_t> countOccupiedTexels(const BitGrid& bits);

/// Bytes with the dense grid's content: a voxel radiance and normal (16 B), a texel above six radiances (48 B) and where its children are (4 B).
struct OctreeBytes {
    std::size_t dense = 0;         ///< RadianceVolume::predictGpuBytes
    std::size_t occupiedOnly = 0;  ///< a record each occupied voxel and texel
    std::size_t tilesOfEight = 0;  ///< all eight children of every occupied texel, as Crassin et al. 2011 allocate them
    std::size_t bricks = 0;        ///< the same nodes, each of 36 B (child, colour, normal, six neighbours) and a brick of 3^3 corners of 16 B
};
OctreeBytes octreeBytes(const std::vector<std::size_t>& occupied, int resolution);

}  // namespace lrsm
