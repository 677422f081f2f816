#pragma once

#include "core/base/rng.h"
#include "core/scene/light.h"
#include "reference/path_trace.h"

#include <span>

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

/// Traces rays, counts them, and writes them down when asked.
class Tracer {
  public:
    Tracer(const EmbreeScene& scene, std::span<const LightSampler> lights, std::vector<RecordedRay>* record = nullptr)
        : scene_(scene), lights_(lights), record_(record)
    {
    }

    const Scene& scene() const { return scene_.scene(); }
    std::span<const LightSampler> lights() const { return lights_; }
    float offset(const Vec3& p) const { return scene_.offset(p); }
    std::optional<RayHit> closestHit(const Ray& ray)
    {
        ++(ray.kind == RayKind::eye ? counts.eye : counts.bounce);
        if (record_) record_->push_back({ray, false});
        return scene_.closestHit(ray);
    }
    bool occluded(const Ray& ray)
    {
        ++counts.light;
        if (record_) record_->push_back({ray, true});
        return scene_.occluded(ray);
    }

    RayCounts counts;

  private:
    const EmbreeScene& scene_;
    std::span<const LightSampler> lights_;
    std::vector<RecordedRay>* record_;
};

/// Radiance that `surface` sends towards `toViewer` straight from the lights: sum over lights of (albedo / pi <n.l> + f_s <n.l>) E V, one
/// shadow ray where the light reaches the front of both the shading and the geometric plane. W/(m^2 sr).
Vec3 directLight(Tracer& tracer, const Surface& surface, const Vec3& toViewer);

/// Radiance arriving along -ray.direction. `hitAnything` says whether the ray met a surface.
Vec3 incomingRadiance(Tracer& tracer, const Ray& ray, Transport transport, PathRandom& random, bool& hitAnything);

/// Ray off a surface: starts above its geometric plane.
Ray rayFrom(const Tracer& tracer, const Surface& surface, const Vec3& direction, RayKind kind);

}  // namespace lrsm
