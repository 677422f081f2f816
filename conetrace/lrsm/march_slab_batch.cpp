#include "conetrace/lrsm/march_slab_batch.h"

namespace lrsm {

std::vector<int> laneWidths()
{
    std::vector<int> widths = {4};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) widths.push_back(8);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        widths.push_back(16);
#endif
    return widths;
}

MarchBatch marchSlabBatch(int lanes)
{
    int width = 0;
    for (const int here : laneWidths())
        if (lanes == 0 || here <= lanes) width = here;
#if defined(__x86_64__)
    if (width == 16) return lanes16::marchSlabBatch;
    if (width == 8) return lanes8::marchSlabBatch;
#endif
    return lanes4::marchSlabBatch;
}

}  // namespace lrsm
