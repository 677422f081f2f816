#pragma once

#include "core/base/counters.h"
#include "core/base/formats.h"
#include "core/base/parallel.h"
#include "core/settings/settings.h"
#include "voxel/bit_grid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

/// Radiance and occlusion in voxels, pre-filtered for six directions of travel (Crassin et al., "Interactive Indirect Illumination Using Voxel Cone Tracing",
/// Pacific Graphics 2011, Sec. 4.2; a dense grid, as the LRSM paper compares itself with).
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

/// Directions of travel: 2 axis + (1 where towards lower coordinates): +x, -x, +y, -y, +z, -z.
inline constexpr int kTravelDirections = 6;

/// Level 0: a texel an occupied voxel, radiance (premultiplied by the occlusion, 1) and mean normal of what emits; from level 1 on a texel a direction of
/// travel: radiance and occlusion of its 2^3l voxels as seen on the way through. Values are what `storage` can hold, kept as floats; R16G16B16A16F on a GPU.
/// Radiance is times `preExposure`, as in the RSMs.
struct RadianceVolume {
    float preExposure = 1.0f;
    std::vector<BrickMap> maps;                                           ///< one a level, down to 1^3
    std::vector<Vec4> base;                                               ///< rgb, occlusion; order of maps[0]
    std::vector<Vec4> normals;                                            ///< xyz, length <= 1; w 0
    std::vector<std::array<std::vector<Vec4>, kTravelDirections>> faces;  ///< of level l >= 1, [0] unused
    ConversionCounts conversions;
    Counters counters;

    int levels() const { return int(maps.size()); }
    int resolution() const { return maps.empty() ? 0 : maps.front().resolution; }

    static constexpr std::size_t kGpuTexelBytes = 8;
    /// Dense, as the paper counts: 16 n^3 + 48 (n^3 - 1) / 7.
    static std::size_t predictGpuBytes(int resolution);
};

/// The texels of one level on a GPU, of one texture.
inline std::size_t denseGpuBytes(int resolution)
{
    const auto n = static_cast<std::size_t>(resolution);
    return n * n * n * RadianceVolume::kGpuTexelBytes;
}

template <class Visit>
void forEachArray(const RadianceVolume& volume, Visit&& visit)
{
    visit(volume.base, ArrayTraits{volume.base.empty() ? 0 : denseGpuBytes(volume.resolution())});
    visit(volume.normals, ArrayTraits{volume.normals.empty() ? 0 : denseGpuBytes(volume.resolution())});
    for (std::size_t level = 1; level < volume.faces.size(); ++level)
        for (const std::vector<Vec4>& face : volume.faces[level]) visit(face, ArrayTraits{denseGpuBytes(volume.maps[level].resolution)});
    for (const BrickMap& map : volume.maps) {
        visit(map.bricks, ArrayTraits{0, false});
        visit(map.coordinate, ArrayTraits{0, false});
    }
}

Counters countersOf(const RadianceVolume& volume);

/// The bricks of all levels: level l's are held where an occupied voxel lies within them.
std::vector<BrickMap> mapBricks(const BitGrid& bits);

/// What a volume over these voxels will hold; `levels` as mapBricks gives them.
std::size_t predictRadianceBytes(const std::vector<BrickMap>& maps);
/// The same where every brick is held.
std::size_t predictDenseRadianceBytes(int resolution);

/// Level 0 and the bricks of all levels, dark: occlusion is the bits'.
RadianceVolume darkVolume(const BitGrid& bits);

/// Levels 1 .. of a volume whose base is in place. Travelling along d, of each column of two texels the front one hides the back one, c = front + (1 - a) back,
/// and a texel is ((c00 + c10) + (c01 + c11)) / 4. Each level is made from the stored level below; from the base with what faces away (n.d > facing |n|)
/// dark but opaque.
void buildRadianceMips(RadianceVolume& volume, const VctSettings& settings);
/// One of these levels, from the level below as it is.
void buildRadianceLevel(RadianceVolume& volume, std::size_t level, const VctSettings& settings);

/// Does a surface of this mean normal send nothing to a cone that travels along d? `nAlongD` = n.d
inline bool facesAway(float nAlongD, const Vec3& normal, float facing)
{
    return nAlongD > facing * glm::length(normal);
}

/// As `storage` would hold it.
Vec4 storedTexel(const Vec4& value, const VctSettings& settings, ConversionCounts& counts);

}  // namespace lrsm
