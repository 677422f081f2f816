#pragma once

#include "apps/validate/ladder/cone_samples.h"
#include "apps/validate/ladder/surface_integral.h"

namespace lrsm {

/// Opacity of a cone from its apex to the far end of a recorded step's segment, as each rung of Eq. 1's ladder has it.
struct ConeOpacity {
    double rays = 0.0;       ///< fraction of a bundle that meets a triangle by then; distances along each ray
    double voxelRays = 0.0;  ///< the same bundle in the bits of level 0, nothing before `start_voxels`
    double boxMips = 0.0;    ///< the march's own steps and opacity rule, each opacity the mean over a box as wide as the tap
    double cone = 0.0;       ///< as the march had it
};

/// Bundles are `side`^2 stratified rays over the cone's solid angle.
ConeOpacity coneOpacity(const ConeWorld& world, const EmbreeScene& embree, const RecordedSample& sample, int side, const SampleKey& key);

/// Mean density (per base voxel of length, along `direction`) that the pyramid holds in a cube of edge 2^level about p: exact weights of the texels that it
/// meets, a quarter as wide as the cube or less where the filter is a mean; no interpolation between texels or levels.
double boxDensity(const OpacityPyramid& pyramid, const Vec3& pVoxels, double level, const Vec3& direction);

}  // namespace lrsm
