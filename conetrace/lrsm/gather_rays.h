#pragma once

#include "conetrace/lrsm/gather.h"
#include "core/bvh/embree_scene.h"

/// visibility = rays, voxel-rays: the gather that ray-tracing hardware would run. Each cone's axis is a ray; its light is the LRSM's at the first surface met.
namespace lrsm {

/// As traceCones, of rays through the triangles: E = pi * mean of L over the cones' own directions. The lookup's footprint follows the ray's cone: 2 t
/// tan(half-angle), so `aperture_scale` is its width. Rays start off the surface by what the scene's floats need, and what lies below the geometric horizon is
/// dark. Opacity is the share of rays that meet something. The specular cone is a ray too, its footprint `aperture_scale` of its own cone's. The same bits for
/// any number of threads; not for every build of Embree, whose hits round differently.
Gathered traceRays(const GBuffer& gbuffer, const Camera& camera, const EmbreeScene& scene, const std::vector<Lrsm>& lrsms, const Requirements& needs,
                   const ConeSettings& settings, ConeRecord* record = nullptr);

/// The same through the bits of level 0. Rays start normal_offset_voxels * |n|_1 off the surface (a plane's own voxels end within |n|_1 of it) and read no
/// voxel within start_voxels. A hit is the middle of the first occupied voxel's length along the ray; footprints are no smaller than a voxel. The same bits
/// everywhere.
Gathered traceVoxelRays(const GBuffer& gbuffer, const Camera& camera, const OpacityPyramid& opacity, const std::vector<Lrsm>& lrsms, const Requirements& needs,
                        const ConeSettings& settings, ConeRecord* record = nullptr);

}  // namespace lrsm
