#pragma once

#include "core/base/parallel.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lrsm {

inline constexpr int kTile = 16;                 ///< edge of the square of pixels that is one piece of work
inline constexpr std::size_t kTilesPerTask = 4;  ///< which share their working memory

/// How many tiles cover an edge of a picture.
inline int tilesAlong(int pixels, int tile)
{
    return (pixels + tile - 1) / tile;
}

/// All tiles of a picture, in parallel: startTask() returns what a task does with each of its tiles, visit(tileX, tileY, counts). Returns the counts' sum.
template <class Counts, class StartTask>
Counts forTiles(int width, int height, const StartTask& startTask)
{
    const int tilesX = tilesAlong(width, kTile), tilesY = tilesAlong(height, kTile);
    std::vector<Counts> counts(std::size_t(tilesX) * std::size_t(tilesY));
    parallelFor(counts.size(), kTilesPerTask, [&](std::size_t begin, std::size_t end) {
        auto visit = startTask();
        for (std::size_t tile = begin; tile < end; ++tile) visit(static_cast<int>(tile) % tilesX, static_cast<int>(tile) / tilesX, counts[tile]);
    });
    Counts sum;
    for (const Counts& tile : counts) sum += tile;
    return sum;
}

/// visit(x, y) for the pixels of one tile, row by row.
template <class Visit>
void forPixels(int width, int height, int tileX, int tileY, const Visit& visit)
{
    const int xEnd = std::min(width, (tileX + 1) * kTile), yEnd = std::min(height, (tileY + 1) * kTile);
    for (int y = tileY * kTile; y < yEnd; ++y)
        for (int x = tileX * kTile; x < xEnd; ++x) visit(x, y);
}

}  // namespace lrsm
