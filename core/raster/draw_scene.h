#pragma once

#include "core/raster/rasterize.h"
#include "core/scene/brdf.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"

#include <vector>

namespace lrsm {

/// A scene seen through a world-to-clip matrix, before any shading. Triangles are submitted mesh by mesh.
struct SceneFragments {
    Image<Fragment> fragments;
    RasterCounts counts;
    std::vector<std::uint32_t> firstTriangle;  ///< of each mesh in submission order, and the total at the end
};

/// Draws all meshes: back faces culled except on double-sided materials, fragments that fail the alpha mask dropped (if needs.alphaTest).
SceneFragments drawScene(const Scene& scene, const Mat4& clipFromWorld, const Requirements& needs, int width, int height);

/// The surface point under a covered fragment. firstTriangle as in SceneFragments.
SurfaceHit hitOf(const std::vector<std::uint32_t>& firstTriangle, const Fragment& fragment);

}  // namespace lrsm
