#include "conetrace/vct/march_radiance_batch.h"

#include "voxel/sampling_vectors.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#define LRSM_LANES 4
#define LRSM_LANES_NAMESPACE lanes4
#include "conetrace/vct/march_radiance_unit.inc"
