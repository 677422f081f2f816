#include "conetrace/vct/march_radiance_batch.h"

#include "voxel/sampling_vectors.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>

// Only what stands between push and pop may use wide instructions: with a compiler flag in their place, inline functions that other files share would.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
#define LRSM_LANES 8
#define LRSM_LANES_NAMESPACE lanes8
#include "conetrace/vct/march_radiance_unit.inc"
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif
