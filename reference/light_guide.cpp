#include "reference/light_guide.h"

namespace lrsm {
namespace {

constexpr float kOwnShare = 0.7f;        // of what the tile and its neighbours have seen; the rest is `base`
constexpr std::uint32_t kOwnWeight = 2;  // a tile's counts, against its neighbours' 1
constexpr std::uint32_t kTent[3] = {1, 2, 1};
constexpr double kPriorTries = 16.0, kPriorReach = 0.5;  // what is taken for granted of a texel's visibility, in the tent's units

}  // namespace

SpreadCounts::SpreadCounts(const LightGrids& grids) : side(grids.side()), light(grids.texels()), tried(grids.texels()), reached(grids.texels()) {}

void SpreadCounts::add(const TexelCount& count, std::uint32_t weight)
{
    const std::size_t column = count.texel % side, row = count.texel / side % side, square = count.texel / (side * side) * side * side;
    for (std::size_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 1, side - 1); ++r)
        for (std::size_t c = column > 0 ? column - 1 : 0; c <= std::min(column + 1, side - 1); ++c) {
            const std::uint32_t tent = weight * kTent[r + 1 - row] * kTent[c + 1 - column];
            const std::size_t at = square + r * side + c;
            light[at] += tent * count.light;
            tried[at] += tent * count.tried;
            reached[at] += tent * count.reached;
        }
}

std::uint64_t SpreadCounts::totalLight() const
{
    std::uint64_t total = 0;
    for (const std::uint32_t count : light) total += count;
    return total;
}

TileGuide LightGuide::guideFor(std::size_t tile) const
{
    if (!useful() || (!even.empty() && even[tile])) return {};
    // A tile has seen little: its neighbours have seen the like, and so have neighbouring texels.
    SpreadCounts counts(*grids);
    const int columns = tiles.columns(), x = int(tile) % columns, y = int(tile) / columns;
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, tiles.rows() - 1); ++ny)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, columns - 1); ++nx)
            for (const TexelCount& one : seen[std::size_t(ny * columns + nx)]) counts.add(one, nx == x && ny == y ? kOwnWeight : 1);

    std::vector<float> weights = base, reach(base.size());
    const auto total = double(counts.totalLight());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (total > 0.0) weights[i] = (1.0f - kOwnShare) * base[i] + kOwnShare * float(double(counts.light[i]) / total);
        reach[i] = float(std::sqrt((double(counts.reached[i]) + kPriorReach * kPriorTries) / (double(counts.tried[i]) + kPriorTries)));
    }
    return {{grids, std::move(weights)}, std::move(reach)};
}

}  // namespace lrsm
