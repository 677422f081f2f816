#pragma once

#include "voxel/radiance/isotropic_volume.h"
#include "voxel/radiance/radiance_volume.h"

#include <array>
#include <cstdint>
#include <vector>

/// Radiance in voxels as the wide lookups read it (voxel/radiance/sample_radiance_lanes.inc): made once a frame. Must not outlive the volume.
namespace lrsm {

/// A row of cells is whole words of 32.
inline constexpr int kCellWordShift = 5, kCellsPerWord = 1 << kCellWordShift;

/// One level. Cell (x, y, z), -1 .. n-1 along each axis, lies between the texels x and x + 1, y and y + 1, z and z + 1: what a trilinear lookup blends.
struct RadianceLevel {
    const BrickMap* map = nullptr;
    float texelsPerVoxel = 1.0f;
    bool directional = false;                               ///< a texture a direction of travel; else the first alone
    std::array<const Vec4*, kTravelDirections> textures{};  ///< order of `map`
    const Vec4* normals = nullptr;                          ///< or none
    std::vector<std::int32_t> heldCells;                    ///< a bit a cell: is any of its eight texels not 0?
    int cellsPerEdge() const { return map->resolution + 1; }
    int wordsPerRow() const { return cellsPerEdge() / kCellsPerWord + 1; }
};

struct RadianceView {
    std::vector<RadianceLevel> levels;
    float facing = 2.0f;    ///< as VctSettings
    bool absolute = false;  ///< DirectionWeights
    bool fixed8 = false;    ///< FilterFraction

    RadianceView(const RadianceVolume& volume, const VctSettings& settings, FilterFraction fraction);
    RadianceView(const IsotropicVolume& volume, FilterFraction fraction);

    /// Which levels a lookup blends: the same for all lanes of a step.
    struct Pair {
        int lower;
        float fraction;  ///< toward the next; 0: that is not read
    };
    Pair pairAt(float level) const;
};

}  // namespace lrsm
