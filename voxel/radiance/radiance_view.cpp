#include "voxel/radiance/radiance_view.h"

#include "core/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace {

/// Of a brick: rows of four texels, four bits each.
constexpr int kRows = 16;
constexpr std::uint64_t kRowMask = 15;

/// The texels of one brick that are not 0 in every texture, in the order of BitGrid's bits.
std::uint64_t heldTexels(const RadianceLevel& level, std::size_t place)
{
    std::uint64_t held = 0;
    for (const Vec4* texture : level.textures)
        for (std::size_t k = 0; texture && k < BrickMap::kTexels; ++k) held |= std::uint64_t(texture[place * BrickMap::kTexels + k] != Vec4(0.0f)) << k;
    return held;
}

/// Four texels of a row, from x (a multiple of four) on, are part of five cells of it.
void markRow(std::int32_t* row, int x, std::uint64_t texels)
{
    const std::uint64_t cells = (texels | texels << 1) << (x % kCellsPerWord);
    row[x / kCellsPerWord] |= static_cast<std::int32_t>(static_cast<std::uint32_t>(cells));
    if (cells >> kCellsPerWord) row[x / kCellsPerWord + 1] |= static_cast<std::int32_t>(cells >> kCellsPerWord);
}

void markHeldCells(RadianceLevel& level)
{
    const BrickMap& map = *level.map;
    std::vector<std::uint64_t> held(map.coordinate.size());
    parallelFor(held.size(), kBricksPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t place = begin; place < end; ++place) held[place] = heldTexels(level, place);
    });
    const auto edge = std::size_t(level.cellsPerEdge()), words = std::size_t(level.wordsPerRow());
    level.heldCells.assign(edge * edge * words, 0);
    for (std::size_t place = 1; place < held.size(); ++place) {
        const IVec3 first = map.texelOf(place, 0);
        for (int row = 0; row < kRows; ++row) {
            const std::uint64_t texels = (held[place] >> (4 * row)) & kRowMask;
            if (texels == 0) continue;
            for (int k = 0; k < 4; ++k) {
                const auto y = std::size_t(first.y + (row & 3) + (k & 1)), z = std::size_t(first.z + (row >> 2) + (k >> 1));
                markRow(level.heldCells.data() + (z * edge + y) * words, first.x, texels);
            }
        }
    }
}

std::vector<RadianceLevel> levelsOf(const std::vector<BrickMap>& maps)
{
    std::vector<RadianceLevel> levels(maps.size());
    for (std::size_t l = 0; l < maps.size(); ++l) {
        levels[l].map = &maps[l];
        levels[l].texelsPerVoxel = 1.0f / float(1 << l);
    }
    return levels;
}

}  // namespace

RadianceView::RadianceView(const RadianceVolume& volume, const VctSettings& settings, FilterFraction fraction)
    : levels(levelsOf(volume.maps)),
      facing(settings.facing),
      absolute(settings.weights == DirectionWeights::absolute),
      fixed8(fraction == FilterFraction::fixed8)
{
    for (std::size_t l = 0; l < levels.size(); ++l) {
        RadianceLevel& level = levels[l];
        level.directional = l > 0;
        if (l == 0) {
            level.textures[0] = volume.base.data();
            level.normals = volume.normals.data();
        } else {
            for (std::size_t d = 0; d < volume.faces[l].size(); ++d) level.textures[d] = volume.faces[l][d].data();
        }
        markHeldCells(level);
    }
}

RadianceView::RadianceView(const IsotropicVolume& volume, FilterFraction fraction) : levels(levelsOf(volume.maps)), fixed8(fraction == FilterFraction::fixed8)
{
    for (std::size_t l = 0; l < levels.size(); ++l) {
        levels[l].textures[0] = volume.levels[l].data();
        markHeldCells(levels[l]);
    }
}

RadianceView::Pair RadianceView::pairAt(float level) const
{
    const float clamped = std::clamp(level, 0.0f, float(levels.size() - 1));
    const float exact = fixed8 ? std::floor(clamped * 256.0f + 0.5f) * (1.0f / 256.0f) : clamped;
    return {int(exact), exact - float(int(exact))};
}

}  // namespace lrsm
