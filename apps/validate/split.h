#pragma once

#include "conetrace/lrsm/gather.h"
#include "reference/embree_scene.h"

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

/// E = pi * mean of L over 16 * strata cosine-weighted directions, those of the slab estimator's cones (cones.h) with all 16 rotations in each
/// pixel and no filter after it. Replaces `gathered`'s irradiance and opacity (the fraction of the rays that hit); all else is left as it is.
///
/// - Exact rays start as the path tracer's do, and see nothing below the geometric horizon.
/// - Voxel rays start normal_offset_voxels * |n|_1 off the surface (a plane's own voxels end within |n|_1 of it), and read no voxel within
///   start_voxels, as the cones do. With exact radiance the surface hit is the first along the ray within the first run of occupied voxels, or a
///   voxel's diagonal before or behind it; a ray that meets voxels but passes by what is in them brings nothing.
/// - The LRSM is looked up at the point hit, with a footprint of one base voxel. What the cones' growing footprints cost is in neither half: it is
///   what the ordinary frame has on top of both.
///
/// Not for {voxel, lrsm}: that is the cones' own picture, and leaves `gathered` as it is. Same bits for any number of threads.
void gatherSplit(const GBuffer& gbuffer, const OpacityPyramid& opacity, const std::vector<Lrsm>& lrsms, const EmbreeScene& embree, const ConeSettings& cones,
                 const SplitSettings& split, Gathered& gathered);

}  // namespace lrsm
