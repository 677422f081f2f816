#pragma once

#include "core/base/rng.h"
#include "reference/light_technique.h"

/// Radiance along single paths: the part of the path tracer that knows physics and nothing of pictures.
namespace lrsm {

/// Random words for the parts of a path that no Sobol dimension covers: the counter runs with the path.
class PathRandom {
  public:
    PathRandom(Philox4 counter, std::array<std::uint32_t, 2> key) : counter_(counter), key_(key) {}
    Philox4 next()
    {
        ++counter_[3];
        return philox(counter_, key_);
    }

  private:
    Philox4 counter_;
    std::array<std::uint32_t, 2> key_;
};

/// The first ray of a path, and the density that it was drawn by, 1/sr.
struct PathStart {
    Ray ray;
    float density = 0.0f;
};

/// In a subset of a pool for further vertices: as many as cost less than the ray to the one that is taken.
inline constexpr std::size_t kVertexCandidates = 16;

/// What is found from the lights' side beside a path's own rays.
struct PathLight {
    LightTechnique first;    ///< that the first ray competes with: who draws the first ray draws from its pool, too
    LightTechnique further;  ///< at further vertices
    const LightPool* furtherPool = nullptr;
    PoolWeights* scratch = nullptr;
};

/// Radiance that `surface` sends towards `toViewer` straight from the lights: sum over lights of (albedo / pi <n.l> + f_s <n.l>) E V, one
/// shadow ray where the light reaches the front of both the shading and the geometric plane. W/(m^2 sr).
Vec3 directLight(Tracer& tracer, const Surface& surface, const Vec3& toViewer);

/// Calls visit(light's index, Surface, LightSample) for every light that reaches the front of both planes of what a ray has struck. Most points are in shadow:
/// the shadow rays go first, and the material is looked up only where light arrives.
template <class Visit>
void visitLights(Tracer& tracer, const Ray& ray, const RayHit& hit, const Visit& visit);

/// Radiance arriving along -ray.direction, less what technique b claims of it. `hitAnything` says whether the ray met a surface.
Vec3 incomingRadiance(Tracer& tracer, const PathStart& start, const PathLight& light, Transport transport, PathRandom& random, bool& hitAnything);

template <class Visit>
void visitLights(Tracer& tracer, const Ray& ray, const RayHit& hit, const Visit& visit)
{
    const float length2 = glm::dot(hit.scaledNormal, hit.scaledNormal);
    if (!(length2 > 0.0f)) return;
    const Vec3 geometricNormal = hit.scaledNormal / std::sqrt(length2), position = positionOf(tracer.scene(), hit.surface);
    std::optional<Surface> surface;
    for (std::size_t k = 0; k < tracer.lights().size(); ++k) {
        const LightSample sample = tracer.lights()[k](position);
        if (sample.irradiance == Vec3(0.0f) || !(glm::dot(geometricNormal, sample.toLight) > 0.0f)) continue;
        if (!tracer.lit(position, geometricNormal, sample)) continue;
        if (!surface) surface = evaluateSurface(tracer.scene(), hit.surface, -ray.direction);
        visit(k, *surface, sample);
    }
}

}  // namespace lrsm
