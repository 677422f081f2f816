#pragma once

#include "core/scene/scene.h"

#include <optional>
#include <vector>

/// What a camera or a light meets, by a few hundred rays and without any acceleration structure: enough to say how far it reaches, before a scene is posed
/// for the passes.
namespace lrsm {

/// Rays of a square pencil from one point, or side by side.
struct Viewpoint {
    Vec3 position{0.0f};
    Vec3 forward{0.0f, 0.0f, -1.0f}, up{0.0f, 1.0f, 0.0f};  ///< unit, at right angles
    float halfWidth = 1.0f, halfHeight = 1.0f;              ///< of the rays' ends, a metre ahead; parallel: of their origins, metres
    bool parallel = false;                                  ///< all along forward
    bool round = false;                                     ///< rays in the inscribed ellipse alone
};

/// A camera, for a picture of 16:9; a spot's cone; a cube face. A directional light has no one point.
Viewpoint viewpointOf(const Camera& camera);
Viewpoint viewpointOf(const Light& light);

struct CoarseHit {
    double distance = 0.0;  ///< along its ray, metres
    Vec3 position{0.0f};
    std::uint32_t mesh = 0;
    bool front = true;  ///< the ray came from the triangle's front
    /// Another material's mesh lies in the same plane there, by triangles of its own: which of them a picture shows is decided by rounding.
    std::optional<std::uint32_t> contender;
};

inline constexpr int kCoarseEdge = 32;  ///< rays along an edge

struct CoarseView {
    std::vector<CoarseHit> hits;  ///< nearest along each ray that meets anything
    std::size_t rays = 0;         ///< cast
};

/// Backs of single-sided materials are looked through, as eye and light do; alpha masks are solid. Linear in the triangles.
CoarseView coarseView(const Scene& scene, const Viewpoint& from);

}  // namespace lrsm
