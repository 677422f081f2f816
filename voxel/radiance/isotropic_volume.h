#pragma once

#include "core/base/arrays.h"
#include "core/base/counters.h"
#include "core/base/formats.h"
#include "core/settings/settings.h"
#include "voxel/radiance/brick_map.h"

#include <vector>

/// Radiance and opacity in voxels, pre-filtered alike for all directions: Rehfeld, Zirr and Dachsbacher, "Clustered Pre-convolved Radiance Caching", EGPGV 2014
/// ([C]), Sec. 3.1.
namespace lrsm {

/// Texels are radiance times the opacity and the pre-exposure, and opacity; R16G16B16A16F on a GPU. Values are what rc_storage can hold.
struct IsotropicVolume {
    float preExposure = 1.0f;
    std::vector<BrickMap> maps;             ///< one a level, down to 1^3
    std::vector<std::vector<Vec4>> levels;  ///< order of `maps`; level 0 alone as lit: (L, 1) in occupied voxels
    ConversionCounts conversions;

    int resolution() const { return maps.empty() ? 0 : maps.front().resolution; }
    /// Dense: 8 n^3 + 8 (n^3 - 1) / 7.
    static std::size_t predictGpuBytes(int resolution);
};

template <class Visit>
void forEachArray(const IsotropicVolume& volume, Visit&& visit)
{
    for (std::size_t level = 0; level < volume.levels.size(); ++level) visit(volume.levels[level], ArrayTraits{denseGpuBytes(volume.maps[level].resolution)});
    for (const BrickMap& map : volume.maps) {
        visit(map.bricks, ArrayTraits{0, false});
        visit(map.coordinate, ArrayTraits{0, false});
    }
}

Counters countersOf(const IsotropicVolume& volume);

/// Levels 1 .. from level 0, each from the stored level below. Surface coverage: of the eight texels below,
///
///     a = min(1, sum a_i / 4),   rgb = sum rgb_i a / sum a_i
///
/// so that a wall one voxel thick stays opaque at every level and rgb is its radiance times a; the mean of [C]'s "volume coverage" would halve a.
void prefilterRadiance(IsotropicVolume& volume, const CacheSettings& settings);
/// One of these levels, from the level below as it is.
void prefilterRadianceLevel(IsotropicVolume& volume, std::size_t level, const CacheSettings& settings);

/// Rounding of one level in float32: of a, and of rgb over the largest.
inline constexpr float kCoverageMaxError = 6e-7f;

/// What a volume over these levels' bricks will hold.
inline std::size_t predictIsotropicBytes(const std::vector<BrickMap>& maps)
{
    return predictBrickBytes(maps, 1, 1);
}

}  // namespace lrsm
