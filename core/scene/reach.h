#pragma once

#include "core/scene/scene.h"

#include <optional>

/// Which part of the world matters to a picture: what its camera and its lights reach.
namespace lrsm {

/// Distance, in metres, within which a camera sees kReachShare of what matters of all that it sees; a surface at distance d counts 1 / sqrt(d), so that neither
/// a sky nor a leaf decides alone. (Of what a local light strikes, d counts 1 / d^2, as what it sends back does.) An orthographic camera sees from no
/// point: distances count from the middle of what it meets, alike within half its picture's height, and that middle's own from the camera is added.
/// Nothing where it sees nothing.
std::optional<double> reachOf(const Scene& scene, const Camera& camera);
inline constexpr double kReachShare = 0.9;

/// The box to which voxel grid and light maps are fitted. Scene::bounds unless these are more than kReachGain times as long; then the bounds of the vertices
/// within twice the reach of the camera or of a local light, and of what local lights strike within theirs (with a sun, of what the camera sees within twice
/// its own). Lights so far away or faint that they bring to nothing that the camera sees within its reach more than 1/256 of its light, straight or from what
/// they strike, do not widen it. It is grown to what stands within its own length as far as that leaves it a part, and with a sun to all surfaces
/// within its own length, which reflect to what is seen. A ground, a sky or a stray triangle thus costs next to nothing: it
/// lies in the grid where it passes through.
Aabb measureReach(const Scene& scene, const Camera& camera);
inline constexpr float kReachGain = 4.0f;

/// Where coordinates count from: the multiple of a power of two (each axis its own) nearest to the camera, which is 0 where the camera stands within some
/// kOriginReach reaches of 0 already: moving would gain less than five bits.
glm::dvec3 chooseOrigin(const Scene& scene, const Camera& camera);
inline constexpr double kOriginReach = 4.0;

}  // namespace lrsm
