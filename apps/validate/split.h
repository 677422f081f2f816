#pragma once

#include "conetrace/frame/gather.h"

/// Which half of the gather does an error come from: finding the surfaces, or knowing their light? Each half can be taken exactly, by Embree;
/// the picture with both halves approximate is the ordinary frame's.
namespace lrsm {

enum class Visibility {
    voxel,  ///< rays through the bits of level 0
    exact   ///< rays through the triangles
};
enum class Radiance {
    lrsm,  ///< what the LRSM holds for the surface that was hit (hit_radiance.h)
    exact  ///< direct light at that surface, diffusely reflected; a shadow ray a light
};

struct SplitSettings {
    Visibility visibility = Visibility::exact;
    Radiance radiance = Radiance::exact;
    int strata = 32;  ///< equal-weight strata of the hemisphere, 1..256; each pixel sends 16 rays through each
};

/// The gather by rays, one more method on the frame's seam: E = pi * mean of L over 16 * strata cosine-weighted directions, those of the slab
/// estimator's cones (cones.h) with all 16 rotations in each pixel and no filter after it; opacity is the fraction of the rays that hit. The
/// specular light is the cones'.
///
/// - Exact rays start as the path tracer's do, and see nothing below the geometric horizon.
/// - Voxel rays start normal_offset_voxels * |n|_1 off the surface (a plane's own voxels end within |n|_1 of it), and read no voxel within
///   start_voxels, as the cones do. With exact radiance the surface hit is the first along the ray within the first run of occupied voxels, or a
///   voxel's diagonal before or behind it; a ray that meets voxels but passes by what is in them brings nothing.
/// - The LRSM is looked up at the point hit, with a footprint of one base voxel. What the cones' growing footprints cost is in neither half: it is
///   what the ordinary frame has on top of both.
///
/// {voxel, lrsm} is the cones' own picture: the method is then settings.method's. Same bits for any number of threads.
GatherMethod raysMethod(const SplitSettings& split);

}  // namespace lrsm
