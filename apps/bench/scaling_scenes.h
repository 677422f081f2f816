#pragma once

#include "core/scene/scene.h"

/// Scenes that differ in size alone, made in code.
namespace lrsm {

/// The same surfaces of 4^doublings times as many triangles: each edge is cut in 2^doublings equal parts, 0..10. Neighbours cut a shared edge
/// at the same bits, so no cracks open; normals are interpolated. Throws InputError where more than 2^31 triangles would come.
Scene subdivided(const Scene& scene, int doublings);

/// The scene lit by `count` lights in place of its first (the others are dropped): each has 1/count of the intensity, axes tilted by up to 0.1 in
/// tangent so that no two see the same. Six faces of a point light are not tilted. InputError for a scene without lights.
Scene withLightSplit(const Scene& scene, int count);

}  // namespace lrsm
