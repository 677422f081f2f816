#include "conetrace/proxies/filter.h"

#include "conetrace/frame/same_surface.h"
#include "core/base/parallel.h"

#include <algorithm>

namespace lrsm {
namespace {

constexpr std::size_t kFilterRows = 2;

std::size_t blockAt(const Blocks& blocks, int column, int row)
{
    return std::size_t(row) * std::size_t(blocks.columns()) + std::size_t(column);
}

/// Does the surface go on from a block's pixel to that of the next one, to the right and down? All pixels between have to be of it.
struct BlockLinks {
    std::vector<std::uint8_t> right, down;
};

bool goesOn(const GBuffer& gbuffer, std::size_t from, std::size_t to, std::size_t step)
{
    if (!gbuffer.covered(from)) return false;
    for (; from < to; from += step)
        if (!sameSurface(gbuffer, from, from + step)) return false;
    return true;
}

BlockLinks linkBlocks(const GBuffer& gbuffer, const Blocks& blocks)
{
    const std::size_t count = std::size_t(blocks.columns()) * std::size_t(blocks.rows());
    BlockLinks links{std::vector<std::uint8_t>(count, 0), std::vector<std::uint8_t>(count, 0)};
    parallelFor(std::size_t(blocks.rows()), kFilterRows, [&](std::size_t begin, std::size_t end) {
        for (int row = int(begin); row < int(end); ++row)
            for (int column = 0; column < blocks.columns(); ++column) {
                const std::size_t block = blockAt(blocks, column, row), pixel = blocks.pixel(column, row);
                if (column + 1 < blocks.columns()) links.right[block] = goesOn(gbuffer, pixel, blocks.pixel(column + 1, row), 1);
                if (row + 1 < blocks.rows()) links.down[block] = goesOn(gbuffer, pixel, blocks.pixel(column, row + 1), std::size_t(gbuffer.width));
            }
    });
    return links;
}

/// The blocks about one that links lead to without a step back.
class JoinedWindow {
  public:
    JoinedWindow(const Blocks& blocks, const BlockLinks& links, int radius)
        : blocks_(blocks), links_(links), radius_(radius), joined_(std::size_t(2 * radius + 1) * std::size_t(2 * radius + 1))
    {
    }

    void moveTo(int column, int row)
    {
        std::fill(joined_.begin(), joined_.end(), std::uint8_t(0));
        at(0, 0) = 1;
        for (const int down : {-1, 1})
            for (const int right : {-1, 1})
                for (int j = 0; j <= radius_; ++j)
                    for (int i = 0; i <= radius_; ++i) {
                        const int x = column + i * right, y = row + j * down;
                        if (x < 0 || y < 0 || x >= blocks_.columns() || y >= blocks_.rows()) continue;
                        const bool across = i > 0 && at((i - 1) * right, j * down) && links_.right[blockAt(blocks_, std::min(x, x - right), y)];
                        const bool along = j > 0 && at(i * right, (j - 1) * down) && links_.down[blockAt(blocks_, x, std::min(y, y - down))];
                        if (across || along) at(i * right, j * down) = 1;
                    }
    }

    bool holds(int i, int j) { return at(i, j) != 0; }

  private:
    std::uint8_t& at(int i, int j) { return joined_[std::size_t(j + radius_) * std::size_t(2 * radius_ + 1) + std::size_t(i + radius_)]; }

    const Blocks& blocks_;
    const BlockLinks& links_;
    int radius_;
    std::vector<std::uint8_t> joined_;
};

/// kFilterReach, of two blocks (i, j) apart.
bool isNearEnough(const GBuffer& gbuffer, const Blocks& blocks, const std::vector<float>& nearness, std::size_t block, std::size_t other)
{
    const auto columns = std::size_t(blocks.columns());
    const auto pixelOf = [&](std::size_t b) { return blocks.pixel(int(b % columns), int(b / columns)); };
    const Vec3 between = gbuffer.position.texels[pixelOf(other)] - gbuffer.position.texels[pixelOf(block)];
    const float most = std::max(nearness[block], nearness[other]);
    return glm::dot(between, between) * most * most < kFilterReach * kFilterReach;
}

}  // namespace

std::vector<float> nearnessOfBlocks(const VisibilityLists& lists, const GBuffer& gbuffer, const ProxyCells& cells)
{
    const Blocks blocks{gbuffer.width, gbuffer.height, lists.divisor};
    std::vector<float> nearness(lists.size(), 0.0f);
    parallelFor(std::size_t(blocks.rows()), kFilterRows, [&](std::size_t begin, std::size_t end) {
        for (int row = int(begin); row < int(end); ++row)
            for (int column = 0; column < blocks.columns(); ++column) {
                const std::size_t block = blockAt(blocks, column, row);
                const Vec3 position = gbuffer.position.texels[blocks.pixel(column, row)];
                for (std::size_t entry = lists.first[block]; entry < lists.first[block + 1]; ++entry) {
                    const float distance = std::max(cells.radius, glm::distance(position, cells.lights[lists.cells[entry]].centroid));
                    nearness[block] += lists.share(block, entry) / distance;
                }
            }
    });
    return nearness;
}

VisibilityLists filterVisibility(const VisibilityLists& lists, const GBuffer& gbuffer, const ProxyCells& cells, const ProxySettings& settings)
{
    const Blocks blocks{gbuffer.width, gbuffer.height, lists.divisor};
    const int radius = settings.filterRadius;
    const bool bySurface = settings.filterTest == ProxyFilterTest::surface;
    const BlockLinks links = bySurface ? linkBlocks(gbuffer, blocks) : BlockLinks{};
    const std::vector<float> nearness = bySurface ? nearnessOfBlocks(lists, gbuffer, cells) : std::vector<float>{};

    std::vector<VisibilityLists> rows(std::size_t(blocks.rows()));
    parallelFor(rows.size(), kFilterRows, [&](std::size_t begin, std::size_t end) {
        CellSet seen(cells.grid.count());
        JoinedWindow window(blocks, links, radius);
        for (int row = int(begin); row < int(end); ++row) {
            VisibilityLists& out = rows[std::size_t(row)];
            out.first = {0};
            for (int column = 0; column < blocks.columns(); ++column) {
                const std::size_t block = blockAt(blocks, column, row), pixel = blocks.pixel(column, row);
                if (bySurface) window.moveTo(column, row);
                // Who lends.
                const auto lends = [&](int i, int j, std::size_t neighbour) {
                    if (!gbuffer.covered(neighbour)) return false;
                    if (!bySurface) return lendsVisibility(gbuffer, pixel, neighbour);
                    if (i == 0 && j == 0) return true;
                    const bool isNext = std::max(std::abs(i), std::abs(j)) == 1;
                    return window.holds(i, j) && sameSurface(gbuffer, pixel, neighbour) &&
                           (isNext || isNearEnough(gbuffer, blocks, nearness, block, blockAt(blocks, column + i, row + j)));
                };
                // Eq. 4.
                std::uint32_t rays = 0;
                for (int y = std::max(0, row - radius); y <= std::min(blocks.rows() - 1, row + radius) && gbuffer.covered(pixel); ++y)
                    for (int x = std::max(0, column - radius); x <= std::min(blocks.columns() - 1, column + radius); ++x) {
                        if (!lends(x - column, y - row, blocks.pixel(x, y))) continue;
                        const std::size_t other = blockAt(blocks, x, y);
                        for (std::size_t entry = lists.first[other]; entry < lists.first[other + 1]; ++entry) seen.add(lists.cells[entry], lists.hits[entry]);
                        rays += lists.rays[other];
                    }
                seen.moveTo(out);
                out.first.push_back(static_cast<std::uint32_t>(out.cells.size()));
                out.opacity.push_back(lists.opacity[block]);
                out.lobeOpacity.push_back(lists.lobeOpacity[block]);
                out.rays.push_back(rays);
            }
        }
    });
    return joinRows(rows, lists.divisor);
}

}  // namespace lrsm
