#include "voxel/radiance/radiance_volume.h"

#include "core/base/memory.h"

#include <bit>
#include <cassert>

namespace lrsm {
namespace {

BrickMap mapOf(int resolution, const std::vector<std::uint8_t>& held)
{
    BrickMap map;
    map.resolution = resolution;
    map.bricks.assign(held.size(), 0);
    map.coordinate.push_back(0);  // the zero brick
    for (std::size_t i = 0; i < held.size(); ++i) {
        if (!held[i]) continue;
        map.bricks[i] = std::uint32_t(map.coordinate.size());
        map.coordinate.push_back(std::uint32_t(i));
    }
    return map;
}

/// A brick of the next level covers 2^3 of this one's.
std::vector<std::uint8_t> parents(const std::vector<std::uint8_t>& held, int edge, int parentEdge)
{
    std::vector<std::uint8_t> above(std::size_t(parentEdge) * std::size_t(parentEdge) * std::size_t(parentEdge), 0);
    std::size_t i = 0;
    for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x, ++i)
                if (held[i]) above[(std::size_t(z / 2) * std::size_t(parentEdge) + std::size_t(y / 2)) * std::size_t(parentEdge) + std::size_t(x / 2)] = 1;
    return above;
}

/// The eight texels below one, by the level's parity: bit a of the index is the higher half along axis a.
using Children = std::array<std::size_t, 8>;
Children childrenOf(const BrickMap& below, const IVec3& texel)
{
    Children children;
    for (int k = 0; k < 8; ++k) children[std::size_t(k)] = below.texel(2 * texel.x + (k & 1), 2 * texel.y + ((k >> 1) & 1), 2 * texel.z + (k >> 2));
    return children;
}

/// read(child) is its texel as seen along the direction.
template <class Read>
Vec4 filtered(const Children& children, int direction, const Read& read)
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

/// visit(texel, place in the arrays, counts): counts summed in order.
template <class Visit>
void forCountedTexels(const BrickMap& map, ConversionCounts& total, const Visit& visit)
{
    std::vector<ConversionCounts> counts(map.coordinate.size() / kBricksPerTask + 1);
    forTexels(map, [&](const IVec3& texel, std::size_t at, std::size_t task) { visit(texel, at, counts[task]); });
    for (const ConversionCounts& task : counts) total += task;
}

}  // namespace

IVec3 BrickMap::texelOf(std::size_t place, int k) const
{
    const auto n = std::size_t(edge());
    const std::size_t brick = coordinate[place];
    return {4 * int(brick % n) + (k & 3), 4 * int(brick / n % n) + ((k >> 2) & 3), 4 * int(brick / (n * n)) + (k >> 4)};
}

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

std::vector<BrickMap> mapBricks(const BitGrid& bits)
{
    std::vector<std::uint8_t> held(bits.bricks.size());
    for (std::size_t i = 0; i < held.size(); ++i) held[i] = bits.bricks[i] != 0;
    std::vector<BrickMap> maps{mapOf(bits.grid.resolution, held)};
    while (maps.back().resolution > 1) {
        const int n = maps.back().resolution / 2;
        held = parents(held, maps.back().edge(), BitGrid::bricksPerEdge(n));
        maps.push_back(mapOf(n, held));
    }
    return maps;
}

std::size_t predictRadianceBytes(const std::vector<BrickMap>& maps)
{
    std::size_t bytes = 0;
    for (std::size_t level = 0; level < maps.size(); ++level)
        bytes += maps[level].texelCount() * sizeof(Vec4) * (level == 0 ? 2 : kTravelDirections) +
                 (maps[level].bricks.size() + maps[level].coordinate.size()) * sizeof(std::uint32_t);
    return bytes;
}

std::size_t predictDenseRadianceBytes(int resolution)
{
    std::size_t bytes = 0;
    for (int n = resolution; n >= 1; n /= 2) {
        const auto edge = std::size_t(BitGrid::bricksPerEdge(n)), bricks = edge * edge * edge;
        bytes += (bricks + 1) * BrickMap::kTexels * sizeof(Vec4) * (n == resolution ? 2 : kTravelDirections) + (2 * bricks + 1) * sizeof(std::uint32_t);
    }
    return bytes;
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

Vec4 storedTexel(const Vec4& value, const VctSettings& settings, ConversionCounts& counts)
{
    if (settings.storage == Storage::float32) return value;
    Vec4 stored;
    for (int k = 0; k < 4; ++k) stored[k] = roundToHalf(value[k], settings.halfRounding, counts);
    return stored;
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
        const Children children = childrenOf(below, texel);
        for (int d = 0; d < kTravelDirections; ++d) {
            const auto direction = std::size_t(d);
            const std::vector<Vec4>& finer = volume.faces[level - 1][direction];
            const Vec4 value = level == 1 ? filtered(children, d, fromBase(d)) : filtered(children, d, [&](std::size_t child) { return finer[child]; });
            volume.faces[level][direction][at] = storedTexel(value, settings, counts);
        }
    });
}

}  // namespace lrsm
