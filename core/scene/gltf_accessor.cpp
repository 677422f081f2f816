#include "core/scene/gltf_accessor.h"

#include <cstring>
#include <sstream>

namespace lrsm::gltf {
namespace {

struct Layout {
    int componentType;
    bool normalized;
    std::size_t components, componentSize;
    std::size_t elementSize() const { return components * componentSize; }
};

Layout layoutOf(const tinygltf::Accessor& accessor)
{
    return {.componentType = accessor.componentType,
            .normalized = accessor.normalized,
            .components = std::size_t(tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type))),
            .componentSize = std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType)))};
}

template <class T>
T load(const unsigned char* bytes)
{
    T value;
    std::memcpy(&value, bytes, sizeof value);  // offsets need not be aligned
    return value;
}

std::uint32_t loadIndex(const unsigned char* bytes, int componentType)
{
    switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return *bytes;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return load<std::uint16_t>(bytes);
    default: return load<std::uint32_t>(bytes);
    }
}

float loadFloat(const unsigned char* bytes, const Layout& layout)
{
    const auto scaled = [&](auto value, float max) { return layout.normalized ? std::max(float(value) / max, -1.0f) : float(value); };
    switch (layout.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return scaled(load<std::int8_t>(bytes), 127.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return scaled(*bytes, 255.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return scaled(load<std::int16_t>(bytes), 32767.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return scaled(load<std::uint16_t>(bytes), 65535.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return float(load<std::uint32_t>(bytes));
    default: return load<float>(bytes);
    }
}

/// Calls store(element, bytes) for the base values, then for the sparse ones that replace them. Ranges were checked before.
template <class Store>
void forEachElement(const Document& document, int index, const Store& store)
{
    const tinygltf::Accessor& accessor = document.model.accessors[std::size_t(index)];
    const Layout layout = layoutOf(accessor);
    if (accessor.bufferView >= 0) {
        const std::size_t given = document.model.bufferViews[std::size_t(accessor.bufferView)].byteStride;
        const std::size_t stride = given ? given : layout.elementSize();
        const unsigned char* bytes = bufferViewBytes(document, accessor.bufferView).data() + accessor.byteOffset;
        for (std::size_t i = 0; i < accessor.count; ++i) store(i, bytes + i * stride);
    }
    if (!accessor.sparse.isSparse) return;
    const auto& sparse = accessor.sparse;
    const auto indexSize = std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(sparse.indices.componentType)));
    const unsigned char* indices = bufferViewBytes(document, sparse.indices.bufferView).data() + sparse.indices.byteOffset;
    const unsigned char* values = bufferViewBytes(document, sparse.values.bufferView).data() + sparse.values.byteOffset;
    for (std::size_t i = 0; i < std::size_t(sparse.count); ++i) {
        const std::size_t element = loadIndex(indices + i * indexSize, sparse.indices.componentType);
        if (element >= accessor.count) document.fail(at("accessors", std::size_t(index)) + ".sparse.indices", std::to_string(element) + " is no element");
        store(element, values + i * layout.elementSize());
    }
}

/// An accessor without a buffer view costs the file nothing; this many zeros is more than any honest use.
constexpr std::uint64_t kMaxImplicitElements = 1 << 24;

void checkBufferViews(const Document& document)
{
    for (std::size_t i = 0; i < document.model.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = document.model.bufferViews[i];
        const std::uint64_t size = document.buffers[std::size_t(view.buffer)].size();
        if (view.byteOffset > size || view.byteLength > size - view.byteOffset)
            document.fail(at("bufferViews", i), "reaches past the end of buffer " + std::to_string(view.buffer));
    }
}

/// `count` elements of `size` bytes, `stride` apart, fit in the view. All below 2^54, so nothing overflows.
void checkRange(const Document& document, int view, std::uint64_t offset, std::uint64_t count, std::uint64_t stride, std::uint64_t size,
                const std::string& path)
{
    const std::uint64_t length = document.model.bufferViews[std::size_t(view)].byteLength;
    if (offset > length || (count - 1) * stride + size > length - offset) document.fail(path, "reaches past the end of bufferView " + std::to_string(view));
}

void checkAccessor(const Document& document, std::size_t i)
{
    const tinygltf::Accessor& accessor = document.model.accessors[i];
    const std::string path = at("accessors", i);
    const std::uint64_t size = layoutOf(accessor).elementSize();
    if (accessor.bufferView >= 0) {
        const std::uint64_t given = document.model.bufferViews[std::size_t(accessor.bufferView)].byteStride;
        if (given != 0 && given < size) document.fail(path, "its bufferView's byteStride is smaller than an element");
        checkRange(document, accessor.bufferView, accessor.byteOffset, accessor.count, given ? given : size, size, path);
    } else if (accessor.count > kMaxImplicitElements) {
        document.fail(path + ".count", "more than " + std::to_string(kMaxImplicitElements) + " elements without a bufferView");
    }

    const auto& sparse = accessor.sparse;
    if (!sparse.isSparse) return;
    if (std::uint64_t(sparse.count) > accessor.count) document.fail(path + ".sparse.count", "is larger than the accessor's count");
    const auto indexSize = std::uint64_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(sparse.indices.componentType)));
    checkRange(document, sparse.indices.bufferView, std::uint64_t(sparse.indices.byteOffset), std::uint64_t(sparse.count), indexSize, indexSize,
               path + ".sparse.indices");
    checkRange(document, sparse.values.bufferView, std::uint64_t(sparse.values.byteOffset), std::uint64_t(sparse.count), size, size, path + ".sparse.values");
}

}  // namespace

void checkAccessors(const Document& document)
{
    checkBufferViews(document);
    for (std::size_t i = 0; i < document.model.accessors.size(); ++i) checkAccessor(document, i);
}

std::span<const unsigned char> bufferViewBytes(const Document& document, int view)
{
    const tinygltf::BufferView& v = document.model.bufferViews[std::size_t(view)];
    return std::span(document.buffers[std::size_t(v.buffer)]).subspan(v.byteOffset, v.byteLength);
}

void requireFormat(const Document& document, int accessor, std::string_view allowed, const std::string& jsonPath)
{
    constexpr const char* kComponents[] = {"s8", "u8", "s16", "u16", "", "u32", "f"};  // from 5120 on
    const tinygltf::Accessor& a = document.model.accessors[std::size_t(accessor)];
    const std::string type = document.json["accessors"][std::size_t(accessor)]["type"].get<std::string>();
    const std::string component =
        std::string(a.normalized && a.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT ? "n" : "") + kComponents[a.componentType - TINYGLTF_COMPONENT_TYPE_BYTE];
    bool typeFits = false, componentFits = false;
    std::istringstream words{std::string(allowed)};
    for (std::string word; words >> word;) {
        typeFits |= word == type;
        componentFits |= word == component;
    }
    if (!typeFits || !componentFits)
        document.fail(jsonPath, "accessor " + std::to_string(accessor) + " is " + type + " " + component + ", allowed: " + std::string(allowed));
}

std::vector<float> readFloats(const Document& document, int accessor)
{
    const tinygltf::Accessor& a = document.model.accessors[std::size_t(accessor)];
    const Layout layout = layoutOf(a);
    std::vector<float> values(a.count * layout.components, 0.0f);
    forEachElement(document, accessor, [&](std::size_t element, const unsigned char* bytes) {
        for (std::size_t c = 0; c < layout.components; ++c) {
            const float value = loadFloat(bytes + c * layout.componentSize, layout);
            if (!std::isfinite(value)) document.fail(at("accessors", std::size_t(accessor)), "element " + std::to_string(element) + " is not finite");
            values[element * layout.components + c] = value;
        }
    });
    return values;
}

std::vector<std::uint32_t> readIntegers(const Document& document, int accessor)
{
    const tinygltf::Accessor& a = document.model.accessors[std::size_t(accessor)];
    const Layout layout = layoutOf(a);
    std::vector<std::uint32_t> values(a.count * layout.components, 0);
    forEachElement(document, accessor, [&](std::size_t element, const unsigned char* bytes) {
        for (std::size_t c = 0; c < layout.components; ++c)
            values[element * layout.components + c] = loadIndex(bytes + c * layout.componentSize, layout.componentType);
    });
    return values;
}

}  // namespace lrsm::gltf
