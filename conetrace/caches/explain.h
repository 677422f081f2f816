#pragma once

#include "conetrace/frame/gather.h"

#include <string>

namespace lrsm {

/// Text of which caches one pixel reads, with which weights and at which texels: what `--pixel` prints.
std::string explainCaches(const GatherInput& input, int x, int y);

}  // namespace lrsm
