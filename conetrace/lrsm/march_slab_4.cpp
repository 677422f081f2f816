#include "conetrace/lrsm/march_slab_batch.h"

#include "conetrace/lrsm/march_slab.h"
#include "voxel/sampling_vectors.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#define LRSM_LANES 4
#define LRSM_LANES_NAMESPACE lanes4
#include "conetrace/lrsm/march_slab_unit.inc"
