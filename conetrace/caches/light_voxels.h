#pragma once

#include "conetrace/frame/gather.h"
#include "voxel/radiance/isotropic_volume.h"
#include "voxel/surface/voxel_surface.h"

namespace lrsm {

/// [C] Sec. 3.1, voxel illumination: level 0 of a volume, (L, 1) in each occupied voxel,
///
///     L = sum over lights of albedo L_d <n.l> V / pi
///
/// at the voxel's mean point, n its mean normal made unit (lightSurfels). V by rc_shadow: `cone`, shadowFromCone of shadow_cone_aperture_degrees through
/// `input.opacity`; `rsm`, shadowFromMap of the light's depths.
IsotropicVolume lightVoxels(const GatherInput& input, const VoxelSurface& surface);

}  // namespace lrsm
