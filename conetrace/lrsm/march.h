#pragma once

#include "conetrace/frame/cone.h"
#include "conetrace/frame/schedule.h"
#include "core/settings/settings.h"
#include "lrsm/footprint.h"
#include "lrsm/sample.h"
#include "voxel/opacity_pyramid.h"

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

/// The lookup for any pyramid and setting; the specialised OpacitySampler gives the same bits faster.
struct GenericSampler {
    const OpacityPyramid& pyramid;
    FilterFraction fraction;
    Vec3 operator()(const Vec3& pVoxels, float level) const { return sampleOpacity(pyramid, pVoxels, level, fraction); }
};

/// Working memory of one thread's cones, sized once for the longest schedule.
struct MarchScratch {
    std::vector<float> opticalDepth;  ///< at each segment's end
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

/// Area density, per base voxel of length, that a cone along `direction` meets.
inline float densityAlong(const OpacityPyramid& pyramid, const Vec3& sample, const Vec3& direction)
{
    return pyramid.axes == OpacityAxes::directional ? glm::dot(glm::abs(direction), sample) : sample.x;
}

}  // namespace lrsm
