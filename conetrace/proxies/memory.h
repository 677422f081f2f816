#pragma once

#include "conetrace/frame/memory.h"

namespace lrsm {

/// Rows of the passes "pp cells", "pp march" and "pp filter". How many proxies roulette leaves and how many cells pixels see only rendering tells: of a
/// rendered frame its own; else pp_count proxies, and lists as long as there are rays, or cells in all (`least`: empty ones).
std::vector<MemoryRow> predictProxies(const MemoryQuestion& question);

}  // namespace lrsm
