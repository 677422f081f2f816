#include "conetrace/vct/march_radiance_batch.h"

#include "conetrace/frame/lane_widths.h"

namespace lrsm {

RadianceMarchBatch marchRadianceBatch(int lanes)
{
    switch (laneWidth(lanes)) {
#if defined(__x86_64__)
    case 16: return lanes16::marchRadianceBatch;
    case 8: return lanes8::marchRadianceBatch;
#endif
    default: return lanes4::marchRadianceBatch;
    }
}

}  // namespace lrsm
