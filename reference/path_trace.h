#pragma once

#include "core/base/image.h"
#include "core/scene/camera.h"
#include "reference/integrator.h"
#include "reference/light_guide.h"
#include "reference/sample_sums.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// Ground truth for the picture: a path tracer that shares scene, materials, lights and pixel rays with the real-time passes, and no
/// visibility, filtering or gathering code.
namespace lrsm {

struct ReferenceSettings {
    Transport transport = Transport::single;
    int width = 1280, height = 720;
    int blockBits = 4;                     ///< log2 of the samples stratified against each other, 0..12; the spread is taken over blocks
    float specularApertureDegrees = 0.0f;  ///< full aperture of the cone layer, (0, 170]; 0: the cone layer is left out
    bool fromLights = true;                ///< lit points are found from the lights' side, too; off: by the path's own rays alone
    std::uint64_t seed = 0;
    bool operator==(const ReferenceSettings&) const = default;
};
/// Throws InputError naming field, value and range.
void validate(const ReferenceSettings& settings);

/// What the eye sees: one ray through each pixel's centre, no antialiasing, as in the G-buffer.
struct PrimaryHits {
    Image<Surface> surface;  ///< as far as `covered`
    Image<std::uint8_t> covered;
    Image<Vec3> toEye;   ///< unit
    Image<float> depth;  ///< metres along the viewing axis; 0 where empty
    Image<Vec3> direct;  ///< radiance towards the eye: every light, one shadow ray each, diffuse and specular
};

/// What has been rendered so far. The progress of a tile is how many of the target range's blocks it has seen.
struct ReferenceState {
    SampleRange target;
    SampleSums sums;  ///< of the target range; `ranges` is filled in when finished
    SampleSums base;  ///< finished earlier, joined to `sums` when the target is finished; no ranges: none
    std::vector<std::uint32_t> tileBlocks;
    RayCounts rays;
    SampleFaults faults;
    double seconds = 0.0;  ///< spent tracing
    bool finished() const { return !sums.ranges.empty(); }
};

/// Means with the variance of each mean. Layer names as in the output of `lrsm render`.
struct ReferenceFrame {
    Image<Vec3> direct;            ///< W/(m^2 sr)
    Image<Vec3> irradiance;        ///< indirect, before the receiver's albedo: integral of L <n.w> dw about the shading normal, W/m^2
    Image<Vec3> indirectDiffuse;   ///< albedo * irradiance / pi
    Image<Vec3> indirectSpecular;  ///< the material's own lobe: integral of L f_s <n.w> dw
    Image<Vec3> specularCone;      ///< mean radiance over the cone's solid angle about the mirror direction; empty unless asked for
    Image<Vec3> combined;          ///< direct + indirectDiffuse + indirectSpecular
    Image<float> opacity;          ///< fraction of the diffuse rays that hit anything
    Image<Vec3> irradianceVariance, indirectDiffuseVariance, indirectSpecularVariance, specularConeVariance, combinedVariance;
    Image<float> opacityVariance;  ///< all variances: of the mean; empty images with fewer than two complete blocks
    std::uint64_t samples = 0;
};

/// How fast the same kind of rays go when nothing else is done: what shading, sampling and sums cost is seen against it.
struct BareLoop {
    std::uint64_t rays = 0;
    double seconds = 0.0;
};

/// The part of block `block` that lies in the range.
struct Segment {
    std::uint64_t block;
    std::uint32_t first, last;
};

class PathTracer {
  public:
    /// Builds the BVH, shoots the primary rays, and runs the pilot. `scene` must outlive the tracer.
    PathTracer(const Scene& scene, const Camera& camera, const ReferenceSettings& settings);

    const PrimaryHits& primary() const { return primary_; }
    const EmbreeScene& embree() const { return embree_; }
    const LightGuide& guide() const { return guide_; }
    const ReferenceSettings& settings() const { return settings_; }
    RayCounts primaryRays() const { return primaryRays_; }
    /// Values a pixel in the sums: irradiance and opacity, and with a specular part the lobe and the cone.
    int channels() const;

    ReferenceState start(SampleRange range) const;
    /// Adds a range to a finished state.
    void extend(ReferenceState& state, SampleRange range) const;
    /// Renders until the range is done (true), `stop` is set, or the deadline has passed; what a started tile does is kept.
    bool advance(ReferenceState& state, std::chrono::steady_clock::time_point deadline, const std::atomic<bool>* stop = nullptr) const;
    /// Fraction of the target range done, [0, 1].
    static double progress(const ReferenceState& state);
    /// The picture of complete sums.
    ReferenceFrame resolve(const SampleSums& sums) const;
    double unit() const { return unit_; }

    /// Traces the rays of every `stride`-th tile's first block again, with nothing but the ray queries inside the clock.
    BareLoop timeBareLoop(std::size_t stride) const;

  private:
    void shootPrimary(const Camera& camera);
    /// Adds a tile's samples to the sums, or to those of the block that the range cuts. Returns how many values were not finite.
    SampleFaults addTile(Tracer& tracer, SampleSums& sums, PartialBlock* cut, std::size_t tile, const Segment& segment) const;

    const Scene& scene_;
    ReferenceSettings settings_;
    EmbreeScene embree_;
    std::vector<LightSampler> lights_;
    PrimaryHits primary_;
    RayCounts primaryRays_;
    LightGuide guide_;
    bool specular_ = false;
    double unit_ = 1.0;
};

/// Power of two near the light that the scene's lights throw, so that fixed-point sums keep their relative precision at any exposure.
double sampleUnit(const Scene& scene);

/// The picture of complete sums, given what does not depend on samples: `unit` of the scene, direct light and albedo.
ReferenceFrame resolveFrame(const SampleSums& sums, double unit, const Image<Vec3>& direct, const Image<Vec3>& albedo);

/// All samples of [0, samples), for tests and tools.
ReferenceFrame renderReference(const Scene& scene, const Camera& camera, const ReferenceSettings& settings, std::uint64_t samples);

}  // namespace lrsm
