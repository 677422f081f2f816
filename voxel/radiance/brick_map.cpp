#include "voxel/radiance/brick_map.h"

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

}  // namespace

IVec3 BrickMap::texelOf(std::size_t place, int k) const
{
    const auto n = std::size_t(edge());
    const std::size_t brick = coordinate[place];
    return {4 * int(brick % n) + (k & 3), 4 * int(brick / n % n) + ((k >> 2) & 3), 4 * int(brick / (n * n)) + (k >> 4)};
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

std::size_t predictBrickBytes(const std::vector<BrickMap>& maps, int base, int above)
{
    std::size_t bytes = 0;
    for (std::size_t level = 0; level < maps.size(); ++level)
        bytes += maps[level].texelCount() * sizeof(Vec4) * std::size_t(level == 0 ? base : above) +
                 (maps[level].bricks.size() + maps[level].coordinate.size()) * sizeof(std::uint32_t);
    return bytes;
}

std::size_t predictDenseBrickBytes(int resolution, int base, int above)
{
    std::size_t bytes = 0;
    for (int n = resolution; n >= 1; n /= 2) {
        const auto edge = std::size_t(BitGrid::bricksPerEdge(n)), bricks = edge * edge * edge;
        bytes += (bricks + 1) * BrickMap::kTexels * sizeof(Vec4) * std::size_t(n == resolution ? base : above) + (2 * bricks + 1) * sizeof(std::uint32_t);
    }
    return bytes;
}

std::size_t denseGpuBytes(int resolution)
{
    constexpr std::size_t kTexelBytes = 8;
    const auto n = static_cast<std::size_t>(resolution);
    return n * n * n * kTexelBytes;
}

Vec4 storedTexel(const Vec4& value, Storage storage, HalfRounding rounding, ConversionCounts& counts)
{
    if (storage == Storage::float32) return value;
    Vec4 stored;
    for (int k = 0; k < 4; ++k) stored[k] = roundToHalf(value[k], rounding, counts);
    return stored;
}

}  // namespace lrsm
