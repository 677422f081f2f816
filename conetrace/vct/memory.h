#pragma once

#include "conetrace/frame/memory.h"

namespace lrsm {

/// What the radiance volume will hold. On a GPU it is dense, as the paper's: 16 n^3 + 48 (n^3 - 1) / 7 bytes, known beforehand. Here only bricks near surfaces
/// are held: Unknowns::found voxelizes the scene to count them, `most` takes all, `least` none.
std::vector<MemoryRow> predictRadiance(const MemoryQuestion& question);

/// Bytes of a volume over the scene's bricks, with `base` texels a place in level 0 and `above` in the others, as far as is known.
std::size_t predictHeldBricks(const MemoryQuestion& question, int base, int above);

}  // namespace lrsm
