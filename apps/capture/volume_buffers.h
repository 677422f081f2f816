#pragma once

#include "apps/capture/capture.h"
#include "apps/capture/catalogue.h"
#include "voxel/radiance/brick_map.h"

#include <string>
#include <vector>

/// Volumes held in bricks, and the dense grids that a GPU has (internal to the conversions).
namespace lrsm {

inline constexpr const char* kGridSpace = "grid";

inline std::size_t cubed(int n)
{
    return std::size_t(n) * std::size_t(n) * std::size_t(n);
}

/// Of a texel in the dense grid of edge n.
inline std::size_t denseIndex(const IVec3& at, int n)
{
    return (std::size_t(at.z) * std::size_t(n) + std::size_t(at.y)) * std::size_t(n) + std::size_t(at.x);
}

/// Describes a volume of four channels, in half or in float32.
void addVolume(Catalogue& out, const std::string& name, int resolution, bool half, const Catalogue::Names& components, const Catalogue::Text& text,
               const Tolerance& tolerance, std::uint32_t ddsMip);

/// Texels of the held bricks into the dense grid; all else is 0. The values are representable, so rounding modes do not matter.
void toDense(const BrickMap& map, const std::vector<Vec4>& texels, Buffer& buffer);

/// And back.
std::vector<Vec4> toBricks(const BrickMap& map, const std::vector<Vec4>& dense);

BitGrid nothingOccupied(const Capture& capture);
/// Marks the first voxel of every texel of the level that is not 0 and lies in no brick that `held` has.
void markTexels(const std::vector<Vec4>& texels, int level, const BrickMap* held, BitGrid& occupied);

}  // namespace lrsm
