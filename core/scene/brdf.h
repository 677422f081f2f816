#pragma once

#include "core/scene/camera.h"
#include "core/scene/scene.h"

/// The material at a point, shared by the real-time passes and the reference, so that a difference between them is transport.
namespace lrsm {

/// A point on a triangle: barycentrics b0 + b1 + b2 = 1 for vertices 0, 1, 2.
struct SurfaceHit {
    std::uint32_t mesh = 0;
    std::uint32_t triangle = 0;  ///< in the mesh
    float b1 = 0.0f, b2 = 0.0f;
};

/// World position of a hit, interpolated as evaluateSurface does.
Vec3 positionOf(const Scene& scene, const SurfaceHit& hit);

struct Surface {
    Vec3 position{0.0f};
    Vec3 geometricNormal{0.0f};  ///< unit, of the triangle, on the side of `facing`
    Vec3 normal{0.0f};           ///< unit shading normal (vertex normals, normal map), on the side of `facing`
    Vec3 albedo{0.0f};           ///< diffuse albedo rho in [0, 1], linear
    Vec3 specularColor{0.0f};    ///< F0; exactly 0 where the material has no specular part
    float roughness = 1.0f;      ///< perceptual; GGX alpha = roughness^2
};

/// Interpolates the vertex streams and evaluates the textures at a hit. `toViewer` (any length) is the direction to the eye or light: a
/// double-sided surface's normals are flipped towards it; a shading normal that would face away is pushed back to the tangent plane
/// of that direction (n.v = 0). A single-sided surface seen from behind keeps its normals: the caller culls it.
///
/// Normal maps use the mesh's tangents, else dP/du of the triangle itself, made orthogonal to the shading normal; where the uv are
/// degenerate the map is ignored. Vertex colours multiply the base colour.
///
/// With `spacing`, textures are read trilinearly by their movement over the triangle's plane from pixel to pixel (ray differentials: Igehy, SIGGRAPH 1999);
/// without, at their base level. The alpha test reads the base level always: shadow rays and voxels have no pixels.
Surface evaluateSurface(const Scene& scene, const SurfaceHit& hit, const Vec3& toViewer, const PixelSpacing* spacing = nullptr);

/// Does the alpha test keep this hit? True for materials without a mask.
bool passesAlphaTest(const Scene& scene, const SurfaceHit& hit);

/// True where the material (its factors and textures) can have a specular part anywhere: metallic > 0 or roughness < 1. Elsewhere
/// `specularColor` is exactly 0.
bool hasSpecularPart(const Material& material);

/// Smallest GGX alpha evaluated: a smoother surface shines as this one (a delta light in a perfect mirror has no finite value).
inline constexpr float kMinSpecularAlpha = 1e-3f;

/// GGX specular lobe with Smith height-correlated shadowing and Schlick Fresnel: f_s(l, v) <n.l>. All unit, on the normal's side.
Vec3 evaluateSpecular(const Surface& surface, const Vec3& toLight, const Vec3& toViewer);

/// What a mirror of this normal shows to a viewer in this direction; as long as `toViewer`.
inline Vec3 mirrorDirection(const Vec3& normal, const Vec3& toViewer)
{
    return 2.0f * glm::dot(normal, toViewer) * normal - toViewer;
}

/// `toViewer` (unit) reflected about a half vector of the GGX distribution of visible normals, chosen by a point of the unit disk (Heitz, "Sampling the GGX
/// Distribution of Visible Normals", JCGT 7(4), 2018). Unit; may point below the surface, where the lobe is 0.
Vec3 reflectLobe(const Vec3& normal, float alpha, const Vec3& toViewer, const Vec2& disk);

}  // namespace lrsm
