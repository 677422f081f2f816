#include "conetrace/lrsm/march_slab_batch.h"

#include "conetrace/lrsm/march_slab.h"
#include "voxel/sampling_vectors.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <memory>

#if defined(__x86_64__)
#include <immintrin.h>

// Only what stands between push and pop may use wide instructions: with a compiler flag in their place, inline functions that other files share would.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,avx512f,avx512dq,avx512bw,avx512vl"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,avx512f,avx512dq,avx512bw,avx512vl")
#endif
#define LRSM_LANES 16
namespace lrsm::lanes16 {
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

}  // namespace lrsm::lanes16
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif
