#pragma once

#include "core/settings/settings.h"
#include "lrsm/gaussian_visibility.h"
#include "lrsm/map_view.h"

namespace lrsm {

/// A point on a surface, as a ray finds it.
struct LrsmProbe {
    Vec3 position{0.0f};                ///< world
    Vec3 direction{0.0f, 0.0f, -1.0f};  ///< of the ray, unit: away from the receiver
    float footprint = 0.0f;             ///< metres, edge of the lookup's footprint; not less than one LRSM texel is used
};

/// Radiance that the LRSM holds for a surface whose place is known: Eq. 12 and 14 at a point,
///
///     L = sum over layers that face the receiver of V A R,   V = Phi((z - mu + h) / s) - Phi((z - mu - h) / s),
///
/// with s^2 = var + footprint^2 / 4 as in the slab estimator. A plane's own depths spread by s = footprint / (2 <n.l>) about its depth at
/// the point, so h = 3/2 footprint / <n.l> keeps all of a lit plane (V = 0.997), and a point deeper below the lit depths than that is in shadow.
/// There is no cosine N: what leaves a visible diffuse surface does not depend on the direction. Overlapping layers (Eq. 15) are
/// weighted by their decay.
///
/// A footprint blurs light over edges, into free space, where cones find it again and rays, which end on surfaces, do not; and onto surfaces that the light
/// sees at a slant, which few texels hold and many rays meet. Narrow ones lose and gain the least. (To leave out layers whose normals are not the triangle's
/// own takes the gain and leaves the loss: energy .92 in the Cornell box where both together give 1.02.) `samples` is counted up by the layers looked up.
Vec3 lrsmRadiance(const MapView& map, const LrsmProbe& probe, const ConeSettings& settings, const NormalCdf& phi, std::uint64_t& samples);

}  // namespace lrsm
