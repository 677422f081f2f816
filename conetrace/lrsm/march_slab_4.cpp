#include "conetrace/lrsm/march_slab_batch.h"

#include "conetrace/lrsm/march_slab.h"
#include "voxel/sampling_vectors.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#define LRSM_LANES 4
namespace lrsm::lanes4 {
namespace {
#include "core/base/lanes.inc"

#include "voxel/sample_opacity_lanes.inc"

#include "conetrace/frame/march_batch.inc"

#include "lrsm/sample_lanes.inc"

#include "conetrace/lrsm/march_slab_lanes.inc"
}  // namespace

void marchSlabBatch(const BatchWorld& world, const MarchSchedule& schedule, const ConeBatch& cones, MarchBatchScratch& scratch, ConeBatchResult& result,
                    ConeCounts& counts)
{
    marchSlab(world, schedule, cones, scratch, result, counts);
}

}  // namespace lrsm::lanes4
