#pragma once

#include "conetrace/frame/memory.h"

namespace lrsm {

/// Rows of what the caches are filled from, and of the passes "rc clusters", "rc places" and "rc convolve". How many caches there will be only the picture
/// tells: of a rendered frame its own, else as many as rc_max allows (`least`: none).
std::vector<MemoryRow> predictCaches(const MemoryQuestion& question);

}  // namespace lrsm
