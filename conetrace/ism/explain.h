#pragma once

#include "conetrace/frame/gather.h"

#include <string>

namespace lrsm {

/// Text of which virtual lights shine most on one pixel, and whether their maps let them: what `--pixel` prints.
std::string explainIsm(const GatherInput& input, int x, int y);

}  // namespace lrsm
