#pragma once

#include "conetrace/frame/memory.h"

namespace lrsm {

/// Layers that each light's LRSM will keep. Unknowns::found renders its RSM, which is cheap beside the rest.
std::vector<int> layersKept(const MemoryQuestion& question);

/// What the LRSMs will hold: a row a light, of as many layers as hold a lit texel. Table 2 of the paper stands beside.
std::vector<MemoryRow> predictLrsms(const MemoryQuestion& question);

}  // namespace lrsm
