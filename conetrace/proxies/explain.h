#pragma once

#include "conetrace/frame/gather.h"

#include <string>

namespace lrsm {

/// Text of which lists one pixel reads, which cells are in them, and how each shines: what `--pixel` prints.
std::string explainProxies(const GatherInput& input, int x, int y);

}  // namespace lrsm
