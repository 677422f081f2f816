#include "conetrace/lrsm/march_slab_batch.h"

#include "conetrace/frame/lane_widths.h"

namespace lrsm {

MarchBatch marchSlabBatch(int lanes)
{
    switch (laneWidth(lanes)) {
#if defined(__x86_64__)
    case 16: return lanes16::marchSlabBatch;
    case 8: return lanes8::marchSlabBatch;
#endif
    default: return lanes4::marchSlabBatch;
    }
}

}  // namespace lrsm
