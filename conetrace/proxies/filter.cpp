#include "conetrace/proxies/filter.h"

#include "core/base/parallel.h"

namespace lrsm {
namespace {

constexpr std::size_t kFilterRows = 2;

}  // namespace

VisibilityLists filterVisibility(const VisibilityLists& lists, const GBuffer& gbuffer, int radius, std::size_t cells)
{
    const Blocks blocks{gbuffer.width, gbuffer.height, lists.divisor};
    std::vector<VisibilityLists> rows(std::size_t(blocks.rows()));
    parallelFor(rows.size(), kFilterRows, [&](std::size_t begin, std::size_t end) {
        CellSet seen(cells);
        for (std::size_t y = begin; y < end; ++y) {
            VisibilityLists& out = rows[y];
            out.first = {0};
            const int row = static_cast<int>(y), top = std::max(0, row - radius), bottom = std::min(blocks.rows() - 1, row + radius);
            for (int column = 0; column < blocks.columns(); ++column) {
                const std::size_t block = y * std::size_t(blocks.columns()) + std::size_t(column), pixel = blocks.pixel(column, row);
                const int left = std::max(0, column - radius), right = std::min(blocks.columns() - 1, column + radius);
                std::uint32_t rays = 0;
                for (int j = top; j <= bottom && gbuffer.covered(pixel); ++j)
                    for (int i = left; i <= right; ++i) {
                        const std::size_t neighbour = blocks.pixel(i, j);
                        if (!gbuffer.covered(neighbour) || !lendsVisibility(gbuffer, pixel, neighbour)) continue;
                        const std::size_t other = std::size_t(j) * std::size_t(blocks.columns()) + std::size_t(i);
                        for (const std::uint32_t cell : lists.of(other)) seen.add(cell);
                        rays += lists.rays[other];
                    }
                seen.moveTo(out.cells);
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
