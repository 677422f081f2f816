#pragma once

#include "conetrace/frame/gbuffer.h"
#include "core/settings/settings.h"
#include "lrsm/depth_map.h"
#include "voxel/opacity_pyramid.h"

#include <span>

namespace lrsm {

struct DirectResult {
    Image<Vec3> radiance;  ///< towards the eye, W/(m^2 sr); 0 where nothing was drawn
};

/// Light from all delta lights, reflected once towards the eye: sum over lights of L_d V (albedo <n.l> / pi + f_s <n.l>).
/// `maps` holds one a light, in the scene's order (read by Shadows::hard and pcf alone); `opacity` is read by Shadows::cone alone and may be null
/// otherwise; the scene's triangles are read by Shadows::exact alone. Geometry that faces away from a light is unlit, whatever its shading normal says.
DirectResult traceDirect(const GBuffer& gbuffer, const Scene& scene, const Camera& camera, std::span<const DepthMapView> maps, const OpacityPyramid* opacity,
                         const Requirements& needs, const DirectSettings& settings);

/// Of the cone's half-angle by shadow_cone_aperture_degrees.
float shadowConeTanHalf(const DirectSettings& settings);

/// V by a cone towards the light, Eq. 1 front to back with nothing gathered: the transmittance left at `distance` metres (may be infinite).
float shadowFromCone(const OpacityPyramid& finest, const Vec3& pWorld, const Vec3& nGeometric, const Vec3& toLight, float distance, float tanHalfAperture);

}  // namespace lrsm
