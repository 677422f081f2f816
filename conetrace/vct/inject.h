#pragma once

#include "conetrace/frame/gather.h"
#include "voxel/radiance/radiance_volume.h"
#include "voxel/surface/voxel_surface.h"

namespace lrsm {

/// Does the injection read a VoxelSurface?
inline bool readsSurface(const VctSettings& settings)
{
    return settings.injection == Injection::voxel || settings.injectionWeight == InjectionWeight::area;
}

/// What the lights give each occupied voxel, into level 0 of a volume that is dark yet (levels above are still empty).
///
/// `rsm` ([CNS*11] Sec. 6): per light the mean radiance of its RSM texels in the voxel, lights added; the normal likewise, lights weighted by luminance. A
/// texel whose voxel is empty goes to the nearest occupied of the 26 about it (by centre; the first in x, then y, then z of equals), or nowhere: counted.
/// With `area` a light's mean is times min(1, area of its texels / area of the voxel's surfaces).
/// `voxel`: albedo L_d <n.l> V / pi of the voxel's surfel, V by its light's depth map. Where its normals cancel <n.l> is kMeanCosine and the normal 0.
/// `surface` may be null where readsSurface is false.
RadianceVolume injectRadiance(const GatherInput& input, const VoxelSurface* surface);

}  // namespace lrsm
