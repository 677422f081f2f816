#pragma once

#include "core/settings/settings.h"
#include "lrsm/gaussian_visibility.h"
#include "lrsm/layers.h"

namespace lrsm {

/// A point on a surface, as an exact ray finds it.
struct LrsmProbe {
    Vec3 position{0.0f};                ///< world
    Vec3 direction{0.0f, 0.0f, -1.0f};  ///< of the ray, unit: away from the receiver
    float footprint = 0.0f;             ///< metres, edge of the lookup's footprint; not less than one LRSM texel is used
};

/// Radiance that the LRSM holds for a surface whose place is known exactly: Eq. 12 and 14 at a point,
///
///     L = sum over layers that face the receiver of V A R,   V = Phi((z - mu + h) / s) - Phi((z - mu - h) / s),
///
/// with s^2 = var + footprint^2 / 4 as in the slab estimator. A plane's own depths spread by s = footprint / (2 <n.l>) about its depth at
/// the point, so h = 3/2 footprint / <n.l> keeps all of a lit plane (V = 0.997), and a point deeper below the lit depths than that is in shadow.
/// There is no cosine N: what leaves a visible diffuse surface does not depend on the direction. Overlapping layers (Eq. 15) are
/// weighted by their decay.
///
/// The footprint is meant to be small, a base voxel: a wider one blurs light over edges into free space, where cones find it again and rays,
/// which end on surfaces, do not.
Vec3 lrsmRadiance(const Lrsm& lrsm, const LrsmProbe& probe, const ConeSettings& settings, const NormalCdf& phi);

}  // namespace lrsm
