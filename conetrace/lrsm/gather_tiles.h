#pragma once

#include "conetrace/frame/cone.h"
#include "conetrace/frame/cone_batch.h"
#include "conetrace/lrsm/gather.h"
#include "core/base/parallel.h"

#include <vector>

/// What the gathers by cones and by rays have in common: their output, and the walk over 16x16 tiles.
namespace lrsm {

/// Pictures of the G-buffer's size, all 0; `record`, where given, is made ready for the frame's cones.
Gathered emptyGathered(const GBuffer& gbuffer, const Requirements& needs, const ConeSettings& settings, ConeRecord* record);

inline constexpr std::size_t kTilesPerTask = 4;  ///< which share their working memory

/// All tiles, in parallel: startTask() returns what a task does with each of its tiles, visit(tileX, tileY, counts).
template <class StartTask>
void forTiles(int width, int height, ConeCounts& total, const StartTask& startTask)
{
    const int tilesX = (width + kTile - 1) / kTile, tilesY = (height + kTile - 1) / kTile;
    std::vector<ConeCounts> counts(std::size_t(tilesX) * std::size_t(tilesY));
    parallelFor(counts.size(), kTilesPerTask, [&](std::size_t begin, std::size_t end) {
        auto visit = startTask();
        for (std::size_t tile = begin; tile < end; ++tile) visit(static_cast<int>(tile) % tilesX, static_cast<int>(tile) / tilesX, counts[tile]);
    });
    for (const ConeCounts& tile : counts) total += tile;
}

}  // namespace lrsm
