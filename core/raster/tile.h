#pragma once

#include "core/raster/setup.h"

#include <span>
#include <vector>

namespace lrsm::raster {

/// Draws one tile: all chunks' triangles in submission order, then the barycentrics of the fragments that stayed.
void drawTile(const std::vector<Chunk>& chunks, const Viewport& viewport, int tile, std::span<const std::uint8_t> tested, const FragmentTest& test,
              Image<Fragment>& out);

}  // namespace lrsm::raster
