#pragma once

#include "conetrace/frame/gbuffer.h"
#include "core/settings/settings.h"
#include "lrsm/rsm.h"
#include "voxel/opacity_pyramid.h"

#include <vector>

namespace lrsm {

struct DirectResult {
    Image<Vec3> radiance;  ///< towards the eye, W/(m^2 sr); 0 where nothing was drawn
};

/// Light from all delta lights, reflected once towards the eye: sum over lights of L_d V (albedo <n.l> / pi + f_s <n.l>).
/// `rsms` holds one map a light, in the scene's order (read by Shadows::hard alone); `opacity` is read by Shadows::cone alone and may be null
/// otherwise. Geometry that faces away from a light is unlit, whatever its shading normal says.
DirectResult traceDirect(const GBuffer& gbuffer, const Scene& scene, const Camera& camera, const std::vector<Rsm>& rsms, const OpacityPyramid* opacity,
                         const Requirements& needs, const DirectSettings& settings);

/// V by the RSM's depth: 0 where the nearest texel's surface is nearer to the light than p by more than the bias, else 1. Outside the map: 1.
/// The bias is depthBiasTexels * texel size * (min(tan(angle between normal and light), kMaxBiasSlope) + kFlatBias). A plane's depth changes
/// by up to half a texel's diagonal (0.71 texels) times that tangent between a texel's centre and p: less shadows itself, more leaks light.
/// nGeometric faces the light (unit).
float shadowFromRsm(const Rsm& rsm, const Vec3& pWorld, const Vec3& nGeometric, const Vec3& toLight, float depthBiasTexels);
inline constexpr float kFlatBias = 0.1f;
inline constexpr float kMaxBiasSlope = 16.0f;  ///< beyond (light grazing at 3.6 degrees) a surface may shadow itself rather than leak for metres

/// V by a cone towards the light, Eq. 1 front to back with nothing gathered: the transmittance left at `distance` metres (may be infinite).
float shadowFromCone(const OpacityPyramid& opacity, const Vec3& pWorld, const Vec3& nGeometric, const Vec3& toLight, float distance, float tanHalfAperture);

}  // namespace lrsm
