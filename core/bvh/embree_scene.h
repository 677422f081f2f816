#pragma once

#include "core/scene/brdf.h"
#include "core/scene/scene.h"

#include <memory>
#include <optional>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace lrsm {

/// Which sides of a single-sided material a ray sees. Double-sided materials stop every ray.
///
/// Eye and light follow glTF's culling, as the G-buffer and the RSM do: the eye does not see the back of a single-sided surface, and light
/// passes through it. Everything else is stopped by both sides (as the voxels stop a cone), but the back reflects nothing. On closed
/// meshes the rules agree; on open single-sided sheets a hard shadow is missing where only the back is turned to the light.
enum class RayKind : std::uint32_t {
    eye,     ///< sees fronts only
    bounce,  ///< stopped by both sides
    light    ///< from a point to the light: stopped by faces that turn their front to the light
};

struct Ray {
    Vec3 origin{0.0f};
    Vec3 direction{0.0f, 0.0f, 1.0f};
    float tNear = 0.0f;
    float tFar = kInfinity;
    RayKind kind = RayKind::bounce;
};

struct RayHit {
    SurfaceHit surface;
    float t = 0.0f;
    bool front = true;        ///< the ray came from the triangle's front
    Vec3 scaledNormal{0.0f};  ///< of the triangle, towards the ray's origin, not unit
};

/// Which kinds of rays a scene is asked for: bounces alone need no look at the sides of what they meet, and are faster.
enum class RayKinds { all, bounces };

/// The scene's triangles in Embree: version 3 or 4, `isa=avx2`, ROBUST (watertight), one BVH. Alpha-masked hits are passed through.
/// Same bits for any number of threads: the BVH is built by one. Keeps a pointer to `scene`. Throws MachineError; where the program is built without Embree
/// (LRSM_PASSES_ONLY), always.
class EmbreeScene {
  public:
    explicit EmbreeScene(const Scene& scene, RayKinds kinds = RayKinds::all);
    ~EmbreeScene();  // where GeometryData is complete
    EmbreeScene(EmbreeScene&&) noexcept;
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    std::optional<RayHit> closestHit(const Ray& ray) const;
    bool occluded(const Ray& ray) const;

    const Scene& scene() const { return *scene_; }
    std::size_t bytes() const;  ///< held by Embree

    /// How far a ray must start off a surface at p, along the geometric normal, not to meet it again: 16 float steps of the position
    /// plus a share of the scene's largest coordinate (barycentric interpolation rounds at the size of the vertices).
    float offset(const Vec3& p) const
    {
        const float magnitude = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        return 0x1p-19f * magnitude + floor_;
    }

  private:
    struct GeometryData;
    struct Memory;
    struct Release {
        void operator()(RTCDeviceTy* device) const;
        void operator()(RTCSceneTy* scene) const;
    };
    const Scene* scene_;
    float floor_ = 0.0f;
    std::unique_ptr<GeometryData[]> data_;
    std::unique_ptr<Memory> memory_;  ///< outlives the device, which reports to it
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> embree_;
};

/// As a pass's output: a size, and no arrays of ours.
template <class Visit>
void forEachArray(const EmbreeScene&, Visit&&)
{
}
inline std::size_t bytesOf(const EmbreeScene& scene)
{
    return scene.bytes();
}

}  // namespace lrsm
