#pragma once

#include "conetrace/frame/cone_batch.h"
#include "conetrace/vct/march.h"
#include "voxel/radiance/radiance_view.h"

/// marchRadiance for a batch of cones with one schedule, the same bits: one source (march_radiance_lanes.inc) at the widths that machines have.
namespace lrsm {

/// What a batch reads: made once a frame.
struct RadianceBatchWorld {
    RadianceView view;
    RadianceMarch march;
    explicit RadianceBatchWorld(const VctWorld& world) : view(world.volume, world.vct, world.cones.march.filterFraction), march(marchOf(world)) {}
    RadianceBatchWorld(const IsotropicVolume& volume, const RadianceMarch& how) : view(volume, how.settings.filterFraction), march(how) {}
};

/// What a march keeps of its cones from step to step, and the taps of one level that meet anything.
struct RadianceBatchScratch {
    // By cone.
    alignas(64) float exit[kBatchRoom], transmittance[kBatchRoom], radiance[3][kBatchRoom];
    alignas(64) std::int32_t alive[kBatchRoom];
    // By cone, of the two levels that a step blends.
    alignas(64) std::int32_t held[2][kBatchRoom];  // has a row
    alignas(64) float rows[2][4 * kBatchRoom];     // radiance and opacity, to be transposed
    // By tap.
    alignas(64) std::int32_t cone[kBatchRoom], cell[3][kBatchRoom], texel[8][kBatchRoom], away[kBatchRoom];
    alignas(64) float fraction[3][kBatchRoom];
};

/// Overwrites `result` for the batch's cones; `scratch` needs no content.
using RadianceMarchBatch = void (*)(const RadianceBatchWorld&, const MarchSchedule&, const ConeBatch&, RadianceBatchScratch&, ConeBatchResult&, ConeCounts&);

namespace lanes4 {
void marchRadianceBatch(const RadianceBatchWorld&, const MarchSchedule&, const ConeBatch&, RadianceBatchScratch&, ConeBatchResult&, ConeCounts&);
}
namespace lanes8 {
void marchRadianceBatch(const RadianceBatchWorld&, const MarchSchedule&, const ConeBatch&, RadianceBatchScratch&, ConeBatchResult&, ConeCounts&);
}
namespace lanes16 {
void marchRadianceBatch(const RadianceBatchWorld&, const MarchSchedule&, const ConeBatch&, RadianceBatchScratch&, ConeBatchResult&, ConeCounts&);
}

/// The kernel of a width, as laneWidth takes it.
RadianceMarchBatch marchRadianceBatch(int lanes);

}  // namespace lrsm
