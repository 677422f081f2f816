#include "voxel/radiance/radiance_volume.h"

#include "core/base/memory.h"

#include <bit>
#include <cassert>

namespace lrsm {
namespace {

/// read(child) is its texel as seen along the direction.
template <class Read>
Vec4 filtered(const TexelChildren& children, int direction, const Read& read)
{
    const int axis = direction / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const int front = (direction & 1) << axis, back = front ^ (1 << axis);
    const auto column = [&](int i, int j) {
        const int at = (i << u) | (j << v);
        const Vec4 f = read(children[std::size_t(at | front)]), b = read(children[std::size_t(at | back)]);
        return f + (1.0f - f.w) * b;
    };
    return 0.25f * ((column(0, 0) + column(1, 0)) + (column(0, 1) + column(1, 1)));
}

}  // namespace

std::size_t RadianceVolume::predictGpuBytes(int resolution)
{
    std::size_t bytes = 2 * denseGpuBytes(resolution);
    for (int n = resolution / 2; n >= 1; n /= 2) bytes += kTravelDirections * denseGpuBytes(n);
    return bytes;
}

Counters countersOf(const RadianceVolume& volume)
{
    Counters counters = volume.counters;
    std::size_t bricks = 0;
    for (const BrickMap& map : volume.maps) bricks += map.coordinate.size() - 1;
    counters.push_back({.name = "bricks_held", .value = double(bricks), .describes = true});
    counters.push_back({"half_saturations", double(volume.conversions.halfSaturations)});
    counters.push_back({"nans", double(volume.conversions.nans)});
    return counters;
}

std::size_t predictRadianceBytes(const std::vector<BrickMap>& maps)
{
    return predictBrickBytes(maps, 2, kTravelDirections);
}

std::size_t predictDenseRadianceBytes(int resolution)
{
    return predictDenseBrickBytes(resolution, 2, kTravelDirections);
}

RadianceVolume darkVolume(const BitGrid& bits)
{
    RadianceVolume volume;
    volume.maps = mapBricks(bits);
    const BrickMap& map = volume.maps.front();
    requireMemory(predictRadianceBytes(volume.maps), "voxel radiance", "lower voxel_resolution");
    volume.base.assign(map.texelCount(), Vec4(0.0f));
    volume.normals.assign(map.texelCount(), Vec4(0.0f));
    for (std::size_t place = 1; place < map.coordinate.size(); ++place) {
        const std::uint64_t word = bits.bricks[map.coordinate[place]];
        for (std::size_t k = 0; k < BrickMap::kTexels; ++k) volume.base[place * BrickMap::kTexels + k].w = (word >> k) & 1u ? 1.0f : 0.0f;
    }
    return volume;
}

void buildRadianceMips(RadianceVolume& volume, const VctSettings& settings)
{
    volume.faces.assign(volume.maps.size(), {});
    for (std::size_t level = 1; level < volume.maps.size(); ++level) buildRadianceLevel(volume, level, settings);
}

void buildRadianceLevel(RadianceVolume& volume, std::size_t level, const VctSettings& settings)
{
    const BrickMap &map = volume.maps[level], &below = volume.maps[level - 1];
    for (std::vector<Vec4>& face : volume.faces[level]) face.assign(map.texelCount(), Vec4(0.0f));
    const auto fromBase = [&](int direction) {
        return [&, direction](std::size_t child) {
            const Vec4 texel = volume.base[child];
            const Vec3 normal(volume.normals[child]);
            const float nAlongD = direction & 1 ? -normal[direction / 2] : normal[direction / 2];
            return facesAway(nAlongD, normal, settings.facing) ? Vec4(0.0f, 0.0f, 0.0f, texel.w) : texel;
        };
    };
    forCountedTexels(map, volume.conversions, [&](const IVec3& texel, std::size_t at, ConversionCounts& counts) {
        const TexelChildren children = childrenOf(below, texel);
        for (int d = 0; d < kTravelDirections; ++d) {
            const auto direction = std::size_t(d);
            const std::vector<Vec4>& finer = volume.faces[level - 1][direction];
            const Vec4 value = level == 1 ? filtered(children, d, fromBase(d)) : filtered(children, d, [&](std::size_t child) { return finer[child]; });
            volume.faces[level][direction][at] = storedTexel(value, settings, counts);
        }
    });
}

}  // namespace lrsm
