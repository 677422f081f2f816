#pragma once

#include "conetrace/caches/atlas.h"
#include "conetrace/caches/places.h"
#include "conetrace/frame/gather_plan.h"
#include "conetrace/lrsm/march.h"

/// A cone a texel: [C] Sec. 3.1.
namespace lrsm {

/// The schedule of all cones: a texel's half-angle (texelTanHalf), narrowed by aperture_scale as any cone set's.
MarchSchedule texelSchedule(const CacheSettings& settings, const ConeSettings& cones, int gridResolution);

/// The cones of a cache as a set of one ring, and that schedule: what a capture tells of them.
GatherPlan planCaches(const CacheSettings& settings, const ConeSettings& cones, int gridResolution);

/// Level 0 by the LRSM's slab march, whatever the estimator of other methods; `world.settings` must have it (slabSettings). `lanes`: as marchSlabBatch takes
/// it; the bits are the same.
CacheAtlas fillFromLrsm(const CachePlaces& places, const CacheTables& tables, const ConeWorld& world, const CacheSettings& settings, int lanes = 0);

/// The settings with estimator=slab.
ConeSettings slabSettings(const ConeSettings& settings);

}  // namespace lrsm
