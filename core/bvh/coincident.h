#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// [mesh][triangle]: 1 for every triangle that has the corners of an earlier one which hides it from wherever it is seen; [mesh] is empty where there is none.
/// Under a depth test LESS the earlier one shows; a ray finds either, unless the later are left out. Faces that lie in one plane otherwise (a decal on a wall,
/// the other diagonal) are not found: which of them a picture shows is decided by its depths' rounding, as on a GPU.
std::vector<std::vector<std::uint8_t>> hiddenTriangles(const Scene& scene);

}  // namespace lrsm
