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

#define LRSM_LANES 16
#define LRSM_LANES_NAMESPACE lanes16
#include "core/base/lanes_begin.inc"

#include "conetrace/lrsm/march_slab_unit.inc"

#include "core/base/lanes_end.inc"
#endif
