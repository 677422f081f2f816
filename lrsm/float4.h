#pragma once

#include <cstring>

namespace lrsm {

/// Four floats in one register (a compiler extension that g++ and clang++ share). Each lane is IEEE arithmetic, so the bits are those of scalar code.
using Float4 = float __attribute__((vector_size(16)));

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

inline Float4 splat4(float v)
{
    return Float4{v, v, v, v};
}

}  // namespace lrsm
