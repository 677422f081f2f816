#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// No pixel shows the mesh: its alpha (factor times vertex colours times texels) is below its cutoff everywhere. What is drawn nowhere must stop no cone
/// either.
bool isDrawnNowhere(const Scene& scene, const Mesh& mesh);

}  // namespace lrsm
