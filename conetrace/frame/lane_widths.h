#pragma once

#include <vector>

/// How many cones wide kernels take at a time.
namespace lrsm {

/// Widths that this machine runs, narrowest first: 4, and on x86-64 with AVX2 and AVX-512 (F, DQ, BW, VL) also 8 and 16.
std::vector<int> laneWidths();

/// Of these the widest that is not wider than `lanes`; 0: the widest.
int laneWidth(int lanes);

}  // namespace lrsm
