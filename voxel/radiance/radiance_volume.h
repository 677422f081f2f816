#pragma once

#include "core/base/counters.h"
#include "core/settings/settings.h"
#include "voxel/radiance/brick_map.h"

#include <array>
#include <cstdint>
#include <vector>

/// Radiance and occlusion in voxels, pre-filtered for six directions of travel (Crassin et al., "Interactive Indirect Illumination Using Voxel Cone Tracing",
/// Pacific Graphics 2011, Sec. 4.2; a dense grid, as the LRSM paper compares itself with).
namespace lrsm {

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

    /// Dense, as the paper counts: 16 n^3 + 48 (n^3 - 1) / 7.
    static std::size_t predictGpuBytes(int resolution);
};

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
inline Vec4 storedTexel(const Vec4& value, const VctSettings& settings, ConversionCounts& counts)
{
    return storedTexel(value, settings.storage, settings.halfRounding, counts);
}

}  // namespace lrsm
