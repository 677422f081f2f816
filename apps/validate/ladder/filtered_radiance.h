#pragma once

#include "apps/validate/ladder/light_footprint.h"
#include "lrsm/sample.h"

namespace lrsm {

/// Eq. 15 from a pre-filtered LRSM: the passes' own chain and lookup (trilinear, fractions in float), the terms after it in double. With a float32 LRSM
/// and floor 0 this is rung `mips`; with the stored one and its variance floor rung `table1`.
glm::dvec3 filteredRadiance(const Lrsm& lrsm, const ConeSample& sample, const ConeSettings& settings, double varianceFloor);

}  // namespace lrsm
