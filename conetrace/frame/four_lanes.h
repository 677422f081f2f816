#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

/// Four pixels of a row at a time, with what every machine has: lane by lane the bits of scalar code.
namespace lrsm::four_lanes {

#define LRSM_LANES 4
#include "core/base/lanes.inc"
#undef LRSM_LANES
#undef LRSM_LANES_X86

struct LaneVec3 {
    LaneFloat x, y, z;
};

/// As glm::dot.
inline LaneFloat dot(const LaneVec3& a, const LaneVec3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline LaneVec3 operator-(const LaneVec3& a, const LaneVec3& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

}  // namespace lrsm::four_lanes
