#pragma once

#include "conetrace/caches/atlas.h"
#include "conetrace/caches/places.h"
#include "conetrace/frame/gather_plan.h"
#include "conetrace/lrsm/march.h"
#include "conetrace/vct/march.h"

/// A cone a texel: [C] Sec. 3.1. rc_fill says what it sees.
namespace lrsm {

/// The schedule of all cones: a texel's half-angle h (texelTanHalf), narrowed by aperture_scale as any cone set's. `lrsm`: that of the slab march, whatever the
/// estimator of other methods; `vct`: that of method vct, one sample a step; `voxels`: voxelSchedule.
MarchSchedule texelSchedule(const CacheSettings& settings, const ConeSettings& cones, int gridResolution);

/// [C] Sec. 4, in voxels: the apex lies behind the cache, so that the cone's diameter at distance t is
///
///     d = 3/4 + 2 t tan h
///
/// a step is d/2, the first sample lies half a step away, level = max(0, log2 d). So d grows by 1 + tan h a step, and log2 d by a constant.
MarchSchedule voxelSchedule(float tanHalf, float reachVoxels, int maxSteps);
inline constexpr float kFirstDiameterVoxels = 0.75f;

/// The cones of a cache as a set of one ring, and that schedule: what a capture tells of them.
GatherPlan planCaches(const CacheSettings& settings, const ConeSettings& cones, int gridResolution);

/// Level 0 by the LRSM's slab march; `world.settings` must have it (slabSettings). `lanes`: as marchSlabBatch takes it; the bits are the same.
CacheAtlas fillFromLrsm(const CachePlaces& places, const CacheTables& tables, const ConeWorld& world, const CacheSettings& settings, int lanes = 0);

/// Level 0 by marchRadiance through the volume of method vct, or through lit voxels; `lanes` likewise.
CacheAtlas fillFromVct(const CachePlaces& places, const CacheTables& tables, const VctWorld& world, const CacheSettings& settings, int lanes = 0);
struct VoxelWorld {
    const IsotropicVolume& volume;
    const VoxelGrid& grid;
    const ConeSettings& cones;
    StepOpacity opacity;
};
CacheAtlas fillFromVoxels(const CachePlaces& places, const CacheTables& tables, const VoxelWorld& world, const CacheSettings& settings, int lanes = 0);

/// The settings with estimator=slab.
ConeSettings slabSettings(const ConeSettings& settings);

/// Apex and axis of a texel's cone.
ConeRay texelCone(const CachePlaces& places, const CacheTables& tables, const VoxelGrid& grid, const MarchSettings& march, std::size_t cache,
                  std::size_t texel);

}  // namespace lrsm
