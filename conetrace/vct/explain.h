#pragma once

#include "conetrace/frame/gather.h"

#include <string>

namespace lrsm {

/// Text of how one pixel's cones went, step by step: what `--pixel` prints.
std::string explainVct(const GatherInput& input, int x, int y);

}  // namespace lrsm
