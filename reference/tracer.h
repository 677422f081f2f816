#pragma once

#include "core/bvh/embree_scene.h"
#include "core/scene/light.h"

#include <span>
#include <vector>

/// Rays of the path tracer, and the light that a surface reflects straight from the lights.
namespace lrsm {

enum class Transport {
    single,  ///< what LRSM sets out to compute: direct light and one bounce off diffuse secondary surfaces
    full     ///< any number of bounces (Russian roulette), every BRDF at every vertex
};

/// Rays of each kind, for the ray budget.
struct RayCounts {
    std::uint64_t eye = 0;  ///< from the camera, and from the lights
    std::uint64_t bounce = 0, light = 0;
    std::uint64_t total() const { return eye + bounce + light; }
    RayCounts& operator+=(const RayCounts& other)
    {
        eye += other.eye;
        bounce += other.bounce;
        light += other.light;
        return *this;
    }
    bool operator==(const RayCounts&) const = default;
};

/// A ray as it was traced.
struct RecordedRay {
    Ray ray;
    bool shadow = false;
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
    float lightOffset(std::size_t light) const { return offset(scene().lights[light].position); }

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
    /// Nothing between a point, on the side of its unit geometric normal, and the light that `light` is a sample of.
    bool lit(const Vec3& position, const Vec3& geometricNormal, const LightSample& light)
    {
        return !occluded({position + geometricNormal * offset(position), light.toLight, 0.0f, light.distance, RayKind::light});
    }

    RayCounts counts;

  private:
    const EmbreeScene& scene_;
    std::span<const LightSampler> lights_;
    std::vector<RecordedRay>* record_;
};

/// Ray off a surface: starts above its geometric plane.
inline Ray rayFrom(const Tracer& tracer, const Surface& surface, const Vec3& direction, RayKind kind)
{
    return {surface.position + surface.geometricNormal * tracer.offset(surface.position), direction, 0.0f, kInfinity, kind};
}

/// Surfaces that turn the back of a single-sided material to the path stop it and reflect nothing.
inline bool reflects(const Scene& scene, const RayHit& hit)
{
    return hit.front || scene.materials[static_cast<std::size_t>(scene.meshes[hit.surface.mesh].material)].doubleSided;
}

/// rho / pi <n.l> E: radiance of the diffuse reflection of unshadowed light, W/(m^2 sr).
inline Vec3 diffuseRadiance(const Surface& surface, const LightSample& light)
{
    return surface.albedo / kPi * std::max(0.0f, glm::dot(surface.normal, light.toLight)) * light.irradiance;
}

/// The same of the specular reflection towards `toViewer`.
inline Vec3 specularRadiance(const Surface& surface, const LightSample& light, const Vec3& toViewer)
{
    return surface.specularColor == Vec3(0.0f) ? Vec3(0.0f) : evaluateSpecular(surface, light.toLight, toViewer) * light.irradiance;
}

}  // namespace lrsm
