#pragma once

#include "apps/capture/capture.h"
#include "core/base/errors.h"
#include "core/base/formats.h"
#include "core/base/math.h"
#include "core/base/parallel.h"

#include <algorithm>
#include <cassert>
#include <cstring>

/// Between typed arrays and the bytes of buffers (internal to the conversions).
namespace lrsm {

/// The buffer of this name in a list; nullptr when it is left out.
inline Buffer* findBuffer(std::vector<Buffer>& buffers, const std::string& name)
{
    for (Buffer& buffer : buffers)
        if (buffer.name == name) return &buffer;
    return nullptr;
}

/// Zeroed bytes of the size that shape and dtype say, seen as T.
template <class T>
T* allocate(Buffer& buffer)
{
    assert(sizeof(T) == sizeOf(buffer.dtype));
    buffer.bytes.assign(buffer.elements() * sizeof(T), std::byte{0});
    return reinterpret_cast<T*>(buffer.bytes.data());
}

/// Copies values that lie in memory just as the buffer has them.
template <class T>
void copyTo(std::vector<Buffer>& buffers, const std::string& name, const std::vector<T>& values)
{
    Buffer* buffer = findBuffer(buffers, name);
    if (!buffer) return;
    assert(buffer->elements() * sizeOf(buffer->dtype) == values.size() * sizeof(T));
    buffer->bytes.resize(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(buffer->bytes.data(), values.data(), buffer->bytes.size());
}

/// The buffer's elements as T; InputError when it is not there, or of another element type or count.
template <class T>
std::span<const T> valuesOf(const Capture& capture, const std::string& name, Dtype dtype, std::size_t count)
{
    const Buffer& buffer = capture.at(name);
    if (buffer.dtype != dtype) throw InputError(name, "holds " + std::string(nameOf(buffer.dtype)) + " where " + std::string(nameOf(dtype)) + " is needed");
    if (buffer.bytes.size() != count * sizeOf(dtype))
        throw InputError(name, "holds " + std::to_string(buffer.bytes.size() / sizeOf(dtype)) + " elements where " + std::to_string(count) + " are needed");
    return buffer.as<T>();
}

/// The same as a vector of a type that is made of such elements.
template <class T>
std::vector<T> copyFrom(const Capture& capture, const std::string& name, Dtype dtype, std::size_t count)
{
    const std::size_t perItem = sizeof(T) / sizeOf(dtype);
    const auto bytes = valuesOf<std::byte>(capture, name, dtype, count * perItem);
    std::vector<T> values(count);
    if (count) std::memcpy(values.data(), bytes.data(), count * sizeof(T));
    return values;
}

/// Gives a buffer that is in the list its leading extents.
inline void shape(std::vector<Buffer>& buffers, const std::string& name, std::initializer_list<std::size_t> extents)
{
    if (Buffer* buffer = findBuffer(buffers, name)) std::copy(extents.begin(), extents.end(), buffer->shape.begin());
}

/// Values that lie in memory as the buffer has them.
template <class T>
void fit(std::vector<Buffer>& buffers, const std::string& name, const std::vector<T>& values)
{
    Buffer* buffer = findBuffer(buffers, name);
    if (!buffer) return;
    buffer->bytes.assign(buffer->elements() * sizeOf(buffer->dtype), std::byte{0});
    if (!values.empty()) std::memcpy(buffer->bytes.data(), values.data(), std::min(buffer->bytes.size(), values.size() * sizeof(T)));
}

/// All that a buffer holds.
template <class T>
std::vector<T> allOf(const Capture& capture, const std::string& name, Dtype dtype)
{
    return copyFrom<T>(capture, name, dtype, capture.at(name).elements() * sizeOf(dtype) / sizeof(T));
}

/// Index lists are read by other passes: what points outside would be read outside.
inline void refuseBeyond(const std::vector<std::uint32_t>& values, std::size_t most, const std::string& name)
{
    for (const std::uint32_t value : values)
        if (value > most) throw InputError(name, "holds " + std::to_string(value) + " where " + std::to_string(most) + " is the most");
}

inline void refuseUnsorted(const std::vector<std::uint32_t>& values, std::size_t most, const std::string& name)
{
    refuseBeyond(values, most, name);
    if (!std::is_sorted(values.begin(), values.end())) throw InputError(name, "is not in order");
}

/// Texels of four channels, stored as halves or as float32.
inline std::vector<Vec4> texelsOf(const Capture& capture, const std::string& name, std::size_t count)
{
    if (capture.at(name).dtype == Dtype::f4) return copyFrom<Vec4>(capture, name, Dtype::f4, count);
    constexpr std::size_t kChannels = 4, kTexelsPerTask = std::size_t(1) << 16;
    const auto halves = valuesOf<std::uint16_t>(capture, name, Dtype::f2, count * kChannels);
    std::vector<Vec4> texels(count);
    parallelFor(count, kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t c = 0; c < kChannels; ++c) texels[i][int(c)] = floatFromHalf(halves[i * kChannels + c]);
    });
    return texels;
}

}  // namespace lrsm
