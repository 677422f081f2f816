#include "conetrace/frame/lane_widths.h"

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

int laneWidth(int lanes)
{
    int width = 0;
    for (const int here : laneWidths())
        if (lanes == 0 || here <= lanes) width = here;
    return width;
}

}  // namespace lrsm
