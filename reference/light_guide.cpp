#include "reference/light_guide.h"

namespace lrsm {
namespace {

constexpr float kOwnShare = 0.7f;                        // of what the tile and its neighbours have seen; the rest is `base`
constexpr std::uint32_t kOwnWeight = 2;                  // a tile's counts, against its neighbours' 1
constexpr double kPriorTries = 16.0, kPriorReach = 0.5;  // what is taken for granted of a texel's visibility, in the tent's units

/// Twice each of `count` values, and its neighbours on both sides.
void spreadLine(std::uint32_t* values, std::size_t count, std::size_t stride)
{
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t here = values[i * stride];
        values[i * stride] = before + 2 * here + (i + 1 < count ? values[(i + 1) * stride] : 0);
        before = here;
    }
}

}  // namespace

SpreadCounts::SpreadCounts(const LightGrids& grids) : side(grids.side()), light(grids.texels()), tried(grids.texels()), reached(grids.texels()) {}

void SpreadCounts::add(const TexelCount& count, std::uint32_t weight)
{
    light[count.texel] += weight * count.light;
    tried[count.texel] += weight * count.tried;
    reached[count.texel] += weight * count.reached;
}

void SpreadCounts::spread()
{
    for (std::vector<std::uint32_t>* counts : {&light, &tried, &reached})
        for (std::size_t square = 0; square < counts->size(); square += side * side) {
            for (std::size_t row = 0; row < side; ++row) spreadLine(counts->data() + square + row * side, side, 1);
            for (std::size_t column = 0; column < side; ++column) spreadLine(counts->data() + square + column, side, side);
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
    counts.spread();

    std::vector<float> weights = base, reach(base.size());
    const auto total = double(counts.totalLight());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (total > 0.0) weights[i] = (1.0f - kOwnShare) * base[i] + kOwnShare * float(double(counts.light[i]) / total);
        reach[i] = float(std::sqrt((double(counts.reached[i]) + kPriorReach * kPriorTries) / (double(counts.tried[i]) + kPriorTries)));
    }
    return {{grids, std::move(weights)}, std::move(reach)};
}

}  // namespace lrsm
