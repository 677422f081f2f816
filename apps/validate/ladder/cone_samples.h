#pragma once

#include "conetrace/frame/gbuffer.h"
#include "conetrace/lrsm/gather_pixel.h"

#include <cstdint>

/// Which cone samples the ladder climbs at: drawn from the frame's own gather.
namespace lrsm {

/// One (pixel, cone, step) at which the march asked the LRSMs for light, as the march saw it.
struct RecordedSample {
    std::uint64_t key = 0;  ///< Philox of (pixel, cone, step) under the seed
    int x = 0, y = 0, cone = 0, step = 0;
    bool specular = false;
    ConeSample sphere;
    ConeRay ray;
    float tanHalf = 0.0f;
    float coneWeight = 0.0f;           ///< of its cone; a pixel's diffuse cones sum to 1, a specular cone is 1
    const MarchStep* steps = nullptr;  ///< of the cone's schedule, up to and including `step`: owned by the GatherPlan
    double before = 1.0;               ///< transmittance in front of the step's segment, as the march computed it
    double after = 1.0;                ///< and behind it
};

struct SampledFrame {
    std::vector<RecordedSample> samples;  ///< in order of pixel, cone, step
    std::uint64_t lookups = 0;            ///< of the whole frame
};

/// Key of one lookup: 64 bits of Philox, the same for any thread that asks.
std::uint64_t lookupKey(std::uint32_t pixel, int cone, int step, std::uint64_t seed);

/// Runs the gather of every covered pixel and keeps the `count` lookups with the smallest keys: a uniform draw without replacement, since keys are
/// independent of what is drawn. Same samples for any number of threads. `plan` and `world` must outlive the result.
SampledFrame sampleGather(const GBuffer& gbuffer, const Camera& camera, const ConeWorld& world, const GatherPlan& plan, std::size_t count, std::uint64_t seed);

}  // namespace lrsm
