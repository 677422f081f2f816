#pragma once

#include "conetrace/frame/cone.h"
#include "conetrace/frame/schedule.h"
#include "core/settings/settings.h"
#include "lrsm/footprint.h"
#include "lrsm/sample.h"
#include "voxel/sample_opacity.h"

#include <vector>

/// One cone through the voxels and the LRSMs: the seam behind which the estimators stand. Each estimator is one function template with the same
/// signature, ConeResult march...(const ConeWorld&, const Sampler&, const ConeRay&, const MarchSchedule&, MarchScratch&, ConeCounts&, Recorder&);
/// marchCone in gather_pixel.h picks one. The sampler is the opacity pyramid's lookup: specialised in a frame, generic for --pixel.
namespace lrsm {

/// Everything that a cone reads.
struct ConeWorld {
    const OpacityPyramid& opacity;
    const std::vector<Lrsm>& lrsms;  ///< one a light; their radiance adds
    const ConeSettings& settings;
    const NormalCdf& phi;
};

/// One a cascade, finest first: a receiver's cones count in the voxels of its own.
inline std::vector<ConeWorld> cascadeWorlds(const ConeWorld& finest)
{
    std::vector<ConeWorld> worlds;
    for (const OpacityPyramid* pyramid = &finest.opacity; pyramid; pyramid = nextCascade(*pyramid))
        worlds.push_back({.opacity = *pyramid, .lrsms = finest.lrsms, .settings = finest.settings, .phi = finest.phi});
    return worlds;
}

/// What turns gathered radiance into the scene's units. All maps have the scene's one pre-exposure, a power of two: exponents alone change.
inline float unexposed(const std::vector<Lrsm>& lrsms)
{
    return lrsms.empty() ? 1.0f : 1.0f / lrsms.front().preExposure;
}

/// The lookup for any pyramid, cascades and setting; the specialised OpacitySampler gives the same bits faster.
struct GenericSampler {
    const OpacityPyramid& pyramid;
    FilterFraction fraction;
    Vec3 operator()(const Vec3& pVoxels, float level) const { return sampleOpacity(pyramid, pVoxels, level, fraction); }
    template <class Visit>
    void forParts(const Vec3& pVoxels, float level, const Visit& visit) const
    {
        forOpacityParts(pyramid, pVoxels, level, fraction, visit);
    }
};

/// A lookup in its parts, one a cascade, where the sampler tells them; else as one.
template <class Sampler, class Visit>
void forTapParts(const Sampler& sampler, const Vec3& pVoxels, float level, const Visit& visit)
{
    if constexpr (requires { sampler.forParts(pVoxels, level, visit); })
        sampler.forParts(pVoxels, level, visit);
    else
        visit(sampler(pVoxels, level));
}

/// Working memory of one thread's cones, sized once for the longest schedule.
struct MarchScratch {
    std::vector<Vec3> opticalDepth;  ///< F at each edge of the schedule's taps, by the axis along which it was covered; isotropic: x alone
};

/// What --pixel shows of one step.
struct StepRecord {
    const MarchStep* step = nullptr;
    Vec3 pWorld{0.0f};
    float density = 0.0f;        ///< as read from the voxels
    float alpha = 0.0f;          ///< opacity of this step
    float transmittance = 1.0f;  ///< in front of this step
};

/// The recorder of ordinary frames: everything compiles away.
struct NoRecorder {
    static constexpr bool active = false;
    void step(const StepRecord&) {}
    void layer(int /*light*/, const LayerTerms&, float /*transmittance*/) {}
};

/// A recorder may leave out `layer` (terms are then not collected), and may add `lookup(const ConeSample&)`: told once for each step at which the
/// march asks the LRSMs for light, before it does.
template <class Recorder>
concept RecordsLayers = Recorder::active && requires(Recorder& recorder, const LayerTerms& terms)
{
    recorder.layer(0, terms, 1.0f);
};
template <class Recorder>
concept RecordsLookups = Recorder::active && requires(Recorder& recorder, const ConeSample& sample)
{
    recorder.lookup(sample);
};

inline float sumOf(const Vec3& v)
{
    return v.x + v.y + v.z;
}

/// Area density, per base voxel of length, that a cone along `direction` meets, by axis.
inline Vec3 coveredAlong(const OpacityPyramid& pyramid, const Vec3& sample, const Vec3& direction)
{
    return pyramid.axes == OpacityAxes::directional ? glm::abs(direction) * sample : Vec3(sample.x, 0.0f, 0.0f);
}

}  // namespace lrsm
