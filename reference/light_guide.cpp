#include "reference/light_guide.h"

namespace lrsm {
namespace {

constexpr float kOwnShare = 0.7f;         // of what the tile and its neighbours have seen; the rest is `base`
constexpr std::uint32_t kOwnWeight = 2;   // a tile's counts, against its neighbours' 1
constexpr std::uint32_t kTent[3] = {1, 2, 1};

}  // namespace

void addSpread(std::vector<std::uint32_t>& counts, std::size_t side, const TexelCount& seen, std::uint32_t weight)
{
    const std::size_t column = seen.texel % side, row = seen.texel / side % side, square = seen.texel / (side * side) * side * side;
    for (std::size_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 1, side - 1); ++r)
        for (std::size_t c = column > 0 ? column - 1 : 0; c <= std::min(column + 1, side - 1); ++c)
            counts[square + r * side + c] += weight * seen.count * kTent[r + 1 - row] * kTent[c + 1 - column];
}

LightDensity LightGuide::densityFor(std::size_t tile) const
{
    // A tile has seen little: its neighbours have seen the like, and so have neighbouring texels.
    std::vector<std::uint32_t> counts(grids->texels(), 0);
    const int columns = tiles.columns(), x = int(tile) % columns, y = int(tile) / columns;
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, tiles.rows() - 1); ++ny)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, columns - 1); ++nx)
            for (const TexelCount& one : seen[std::size_t(ny * columns + nx)]) addSpread(counts, grids->side(), one, nx == x && ny == y ? kOwnWeight : 1);
    std::uint64_t total = 0;
    for (const std::uint32_t count : counts) total += count;

    std::vector<float> weights = base;
    if (total > 0)
        for (std::size_t i = 0; i < weights.size(); ++i)
            weights[i] = (1.0f - kOwnShare) * base[i] + kOwnShare * float(double(counts[i]) / double(total));
    return {grids, std::move(weights)};
}

}  // namespace lrsm
