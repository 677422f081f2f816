#include "lrsm/map_view.h"

#include "core/base/parallel.h"

#include <algorithm>
#include <bit>

namespace lrsm {
namespace {

static_assert(std::endian::native == std::endian::little, "an octant's byte is found by its address");

constexpr std::size_t kRowsPerTask = 16;  ///< of texels, a task

/// Octants, a byte each, of which some direction may be faced by this normal: all but those whose signs are the normal's own.
std::uint64_t octantsFaced(const float (&normal)[4])
{
    const auto agree = [](float component, std::uint64_t positive) { return (component >= 0.0f ? positive : 0) | (component <= 0.0f ? ~positive : 0); };
    return ~(agree(normal[0], 0x00ff00ff00ff00ffull) & agree(normal[1], 0x0000ffff0000ffffull) & agree(normal[2], 0x00000000ffffffffull));
}

/// Of the texels of one level, with a border of nothing around them.
struct FacingTexels {
    int row = 0;  ///< resolution + 2
    std::vector<std::uint64_t> octants;
    std::uint64_t& at(int x, int y) { return octants[std::size_t(y + 1) * std::size_t(row) + std::size_t(x + 1)]; }
    std::uint64_t at(int x, int y) const { return octants[std::size_t(y + 1) * std::size_t(row) + std::size_t(x + 1)]; }
};

FacingTexels texelsOf(const Lrsm& lrsm, int lod, int firstLayer, int layers, const FacingTexels& finer)
{
    const int n = lrsm.resolutionAt(lod);
    FacingTexels out{.row = n + 2, .octants = std::vector<std::uint64_t>(std::size_t(n + 2) * std::size_t(n + 2), 0)};
    parallelFor(std::size_t(n), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
        for (int layer = 0; layer < layers; ++layer) {
            const std::uint64_t bit = 0x0101010101010101ull << layer;
            const LrsmTexel* texel = lrsm.level(firstLayer + layer, lod) + begin * std::size_t(n);
            for (int y = int(begin); y < int(end); ++y)
                for (int x = 0; x < n; ++x, ++texel) out.at(x, y) |= octantsFaced(texel->normal) & bit;
        }
        // A lookup between two levels asks the coarser one for both.
        for (int y = int(begin); y < int(end) && lod > 0; ++y)
            for (int x = 0; x < n; ++x)
                out.at(x, y) |= finer.at(2 * x, 2 * y) | finer.at(2 * x + 1, 2 * y) | finer.at(2 * x, 2 * y + 1) | finer.at(2 * x + 1, 2 * y + 1);
    });
    return out;
}

void fillCells(std::uint64_t* cells, const FacingTexels& texels)
{
    const int edge = texels.row - 1;
    parallelFor(std::size_t(edge), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
        for (int y = int(begin); y < int(end); ++y)
            for (int x = 0; x < edge; ++x)
                cells[std::size_t(y) * std::size_t(edge) + std::size_t(x)] =
                    texels.at(x - 1, y - 1) | texels.at(x, y - 1) | texels.at(x - 1, y) | texels.at(x, y);
    });
}

}  // namespace

MapView::MapView(const Lrsm& source) : lrsm(source)
{
    for (int lod = 0; lod < source.levels(); ++lod) {
        firstTexels[std::size_t(lod)] = static_cast<std::int32_t>(source.levelOffset[std::size_t(lod)]);
        firstCells[std::size_t(lod)] = static_cast<std::int32_t>(cellsPerGroup);
        const auto edge = static_cast<std::size_t>(source.resolutionAt(lod)) + 1;
        cellsPerGroup += edge * edge;
    }
    const int groups = (source.layers() + kGroup - 1) / kGroup;
    facing.resize(std::size_t(groups) * cellsPerGroup + 1);  // four bytes are read at a time
    for (int group = 0; group < groups; ++group) {
        const int first = group * kGroup, layers = std::min(kGroup, source.layers() - first);
        FacingTexels finer;
        for (int lod = 0; lod < source.levels(); ++lod) {
            FacingTexels texels = texelsOf(source, lod, first, layers, finer);
            fillCells(facing.data() + std::size_t(group) * cellsPerGroup + std::size_t(firstCells[std::size_t(lod)]), texels);
            finer = std::move(texels);
        }
    }
}

}  // namespace lrsm
