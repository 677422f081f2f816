#pragma once

#include <algorithm>
#include <cstddef>

/// A picture as square tiles, row by row: the unit of work, and of what pixels share.
namespace lrsm {

inline constexpr int kTileSide = 16;
inline constexpr std::size_t kTilePixels = std::size_t(kTileSide) * kTileSide;

/// Pixels [x0, x1) x [y0, y1).
struct Tile {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct TileGrid {
    int width = 0, height = 0;
    int columns() const { return (width + kTileSide - 1) / kTileSide; }
    int rows() const { return (height + kTileSide - 1) / kTileSide; }
    std::size_t count() const { return std::size_t(columns()) * std::size_t(rows()); }
    Tile operator[](std::size_t index) const
    {
        const int x0 = int(index % std::size_t(columns())) * kTileSide, y0 = int(index / std::size_t(columns())) * kTileSide;
        return {x0, y0, std::min(x0 + kTileSide, width), std::min(y0 + kTileSide, height)};
    }
};

/// Calls visit(pixel's index in the picture, its number in the tile).
template <class Visit>
void forEachPixel(const TileGrid& grid, std::size_t tile, const Visit& visit)
{
    const Tile t = grid[tile];
    std::size_t number = 0;
    for (int y = t.y0; y < t.y1; ++y)
        for (int x = t.x0; x < t.x1; ++x) visit(std::size_t(y) * std::size_t(grid.width) + std::size_t(x), number++);
}

}  // namespace lrsm
