#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// How large the scene's buffers are.
struct SceneCounts {
    std::size_t vertices = 0, triangles = 0;
    bool uv0 = false, uv1 = false, tangents = false, colors = false;  ///< some mesh has them
};
SceneCounts countScene(const Scene& scene);

/// No material that a mesh wears reads a texture.
bool withoutTextures(const Scene& scene);

}  // namespace lrsm
