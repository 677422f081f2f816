#pragma once

#include "conetrace/frame/cone_batch.h"
#include "conetrace/lrsm/march.h"
#include "lrsm/map_view.h"
#include "voxel/opacity_view.h"

#include <memory>
#include <utility>
#include <vector>

/// marchSlab for a batch of cones with one schedule, the same bits: one source (march_slab_lanes.inc) at the widths that machines have.
namespace lrsm {

/// A ConeWorld and what the wide kernels keep beside it: made once a frame. Must not outlive it.
struct BatchWorld {
    const ConeWorld& cones;
    OpacityView opacity;
    std::shared_ptr<const std::vector<MapView>> maps;  ///< one a light
    explicit BatchWorld(const ConeWorld& world) : BatchWorld(world, std::make_shared<const std::vector<MapView>>(world.lrsms.begin(), world.lrsms.end())) {}
    /// Of another cascade, with the maps that one keeps already.
    BatchWorld(const ConeWorld& world, std::shared_ptr<const std::vector<MapView>> known)
        : cones(world), opacity(world.opacity, world.settings.march.filterFraction), maps(std::move(known))
    {
    }
};

/// Overwrites `result` for the batch's cones; `scratch` needs no content.
using MarchBatch = void (*)(const BatchWorld&, const MarchSchedule&, const ConeBatch&, MarchBatchScratch&, ConeBatchResult&, ConeCounts&);

namespace lanes4 {
void marchSlabBatch(const BatchWorld&, const MarchSchedule&, const ConeBatch&, MarchBatchScratch&, ConeBatchResult&, ConeCounts&);
}
namespace lanes8 {
void marchSlabBatch(const BatchWorld&, const MarchSchedule&, const ConeBatch&, MarchBatchScratch&, ConeBatchResult&, ConeCounts&);
}
namespace lanes16 {
void marchSlabBatch(const BatchWorld&, const MarchSchedule&, const ConeBatch&, MarchBatchScratch&, ConeBatchResult&, ConeCounts&);
}

/// The kernel of a width, as laneWidth takes it.
MarchBatch marchSlabBatch(int lanes);

}  // namespace lrsm
