#pragma once

#include "conetrace/frame/memory.h"

namespace lrsm {

/// Rows of the passes "pp cells", "pp march" and "pp filter". How many cells pixels see only rendering tells: of a rendered frame its own; else lists as long
/// as there are rays, or cells that hold proxies (`least`: empty ones). That is no less than what is used, and at most kListsFactor times it in the built-ins.
std::vector<MemoryRow> predictProxies(const MemoryQuestion& question);
inline constexpr double kListsFactor = 8.0;

}  // namespace lrsm
