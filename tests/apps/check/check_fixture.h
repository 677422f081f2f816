#pragma once

#include "apps/check/check.h"
#include "core/base/formats.h"

#include <functional>

namespace lrsm::test {

/// A candidate in memory: these buffers of a capture.
inline Candidate candidateOf(
    const Capture& capture, const std::function<bool(const Buffer&)>& has = [](const Buffer&) { return true; })
{
    Candidate candidate;
    candidate.folder = "candidate";
    for (const Buffer& buffer : capture.buffers)
        if (has(buffer)) candidate.buffers.push_back({buffer, {}, buffer.file, ""});
    return candidate;
}

inline bool textHas(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

inline std::uint16_t* codesOf(Buffer& b)
{
    return reinterpret_cast<std::uint16_t*>(b.bytes.data());
}
inline float* floatsOf(Buffer& b)
{
    return reinterpret_cast<float*>(b.bytes.data());
}

/// Sets every value from the golden's values, through the storage.
template <class Formula>
void recompute(Buffer& buffer, const Formula& formula)
{
    const Buffer before = buffer;
    for (std::size_t i = 0; i < valueCount(before); ++i) {
        const double value = formula(before, i);
        if (buffer.dtype == Dtype::f4)
            floatsOf(buffer)[i] = static_cast<float>(value);
        else if (buffer.dtype == Dtype::f2)
            codesOf(buffer)[i] = halfFromFloat(static_cast<float>(value), HalfRounding::nearestEven);
        else if (buffer.dtype == Dtype::u2)
            codesOf(buffer)[i] = unorm16FromFloat(static_cast<float>(value));
        else if (buffer.encoding == Encoding::unorm)
            buffer.bytes[i] = std::byte(unorm8FromFloat(static_cast<float>(value)));
        else if (value != 0.0)
            buffer.bytes[i / 8] |= std::byte(1u << (i & 7));
        else
            buffer.bytes[i / 8] &= ~std::byte(1u << (i & 7));
    }
}

}  // namespace lrsm::test
