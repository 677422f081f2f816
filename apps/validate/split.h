#pragma once

#include "conetrace/frame/gather.h"

/// Which half of the gather does an error come from: finding the surfaces, or knowing their light? visibility=rays finds them exactly and asks the LRSM; this
/// takes the other half exactly.
namespace lrsm {

/// The gather by rays with the light of what they hit by shadow rays in place of the LRSM, diffusely reflected; one more method on the frame's seam. E = pi *
/// mean of L over 16 * strata cosine-weighted directions, those of the slab estimator's cones (cones.h) with all 16 rotations in each pixel and no filter after
/// it; opacity is the fraction of the rays that hit. The specular light is the cones'.
///
/// - Visibility::rays start as the path tracer's do, and see nothing below the geometric horizon.
/// - Visibility::voxelRays start as gather_rays.h says. The surface hit is the first along the ray within the first run of occupied voxels, or a
///   voxel's diagonal before or behind it; a ray that meets voxels but passes by what is in them brings nothing.
///
/// `strata` of equal weight, 1..256. InputError for cones, which hit nothing. Same bits for any number of threads.
GatherMethod exactRadianceMethod(Visibility visibility, int strata = 32);

}  // namespace lrsm
