#pragma once

#include "apps/validate/ladder/cone_samples.h"
#include "apps/validate/ladder/light_footprint.h"
#include "apps/validate/ladder/surface_integral.h"

#include <span>

namespace lrsm {

/// What the slab estimator adds for one segment of a cone in clear air, w A R of march_slab.h summed over layers and lights, and what it stands for. Means of
/// the three channels, W/(m^2 sr).
struct SegmentEmission {
    double rays = 0.0;     ///< mean over `side`^2 rays, parallel to the axis, over the disk as wide as the cone is there: radiance of the first surface inside
                           ///< the segment, 0 for a ray that meets none
    double texels = 0.0;   ///< of the RSM's texels inside the same cylinder, by their area
    double segment = 0.0;  ///< as shipped, with transmittance 1
};

SegmentEmission segmentEmission(const ConeWorld& world, std::span<const Rsm* const> rsms, Tracer& tracer, const RecordedSample& sample, int side,
                                const SampleKey& key);

}  // namespace lrsm
