#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// `reach`, grown by what may stand between it and the light: what of the other triangles lies over it (directional), or the nearest point of each that is no
/// farther from the light than the reach's far end. A stray triangle elsewhere adds nothing.
Aabb withCasters(const Aabb& reach, const Scene& scene, const Light& light);

}  // namespace lrsm
