#pragma once

#include "conetrace/frame/memory.h"

namespace lrsm {

/// Rows of the passes "ism lights" and "ism maps".
std::vector<MemoryRow> predictIsm(const MemoryQuestion& question);

}  // namespace lrsm
