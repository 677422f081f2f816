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
    return {accessor.componentType, accessor.normalized, std::size_t(tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type))),
            std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType)))};
}

const unsigned char* viewData(const Document& document, int view, std::size_t offset)
{
    const tinygltf::BufferView& v = document.model.bufferViews[std::size_t(view)];
    return document.buffers[std::size_t(v.buffer)].data() + v.byteOffset + offset;
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
        const unsigned char* bytes = viewData(document, accessor.bufferView, accessor.byteOffset);
        for (std::size_t i = 0; i < accessor.count; ++i) store(i, bytes + i * stride);
    }
    if (!accessor.sparse.isSparse) return;
    const auto& sparse = accessor.sparse;
    const auto indexSize = std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(sparse.indices.componentType)));
    const unsigned char* indices = viewData(document, sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset));
    const unsigned char* values = viewData(document, sparse.values.bufferView, std::size_t(sparse.values.byteOffset));
    for (std::size_t i = 0; i < std::size_t(sparse.count); ++i) {
        const std::size_t element = loadIndex(indices + i * indexSize, sparse.indices.componentType);
        if (element >= accessor.count) document.fail(at("accessors", std::size_t(index)) + ".sparse.indices", std::to_string(element) + " is no element");
        store(element, values + i * layout.elementSize());
    }
}

}  // namespace

void requireFormat(const Document& document, int accessor, std::string_view allowed, const std::string& jsonPath)
{
    const tinygltf::Accessor& a = document.model.accessors[std::size_t(accessor)];
    const auto typeName = [&]() -> std::string {
        switch (a.type) {
        case TINYGLTF_TYPE_SCALAR: return "SCALAR";
        case TINYGLTF_TYPE_VEC2: return "VEC2";
        case TINYGLTF_TYPE_VEC3: return "VEC3";
        case TINYGLTF_TYPE_VEC4: return "VEC4";
        default: return "MAT";
        }
    };
    const auto componentName = [&]() -> std::string {
        const std::string n = a.normalized ? "n" : "";
        switch (a.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return n + "s8";
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return n + "u8";
        case TINYGLTF_COMPONENT_TYPE_SHORT: return n + "s16";
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return n + "u16";
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return n + "u32";
        default: return "f";
        }
    };
    bool typeFits = false, componentFits = false;
    std::istringstream words{std::string(allowed)};
    for (std::string word; words >> word;) {
        typeFits |= word == typeName();
        componentFits |= word == componentName();
    }
    if (!typeFits || !componentFits)
        document.fail(jsonPath, "accessor " + std::to_string(accessor) + " is " + typeName() + " " + componentName() + ", allowed: " + std::string(allowed));
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
