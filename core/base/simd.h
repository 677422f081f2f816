#pragma once

#include <cstdint>
#include <cstring>

/// Four lanes at a time, with the vector extensions that GCC and clang share: lane by lane plain IEEE arithmetic, so the bits are those of scalar code, and
/// nothing beyond SSE2 (or NEON) is needed.
namespace lrsm {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

inline Float4 splat(float v)
{
    return Float4{v, v, v, v};
}

/// `values` is 16-byte aligned.
inline Float4 loadFloat4(const float* values)
{
    Float4 result;
    std::memcpy(&result, __builtin_assume_aligned(values, 16), sizeof result);
    return result;
}

inline void storeFloat4(float* values, const Float4& v)
{
    std::memcpy(__builtin_assume_aligned(values, 16), &v, sizeof v);
}

}  // namespace lrsm
