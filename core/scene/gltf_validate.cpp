#include "core/scene/gltf_document.h"

namespace lrsm::gltf {
namespace {

/// An accessor without a buffer view costs the file nothing; this many zeros is more than any honest use.
constexpr std::uint64_t kMaxImplicitElements = 1 << 24;

void checkBufferViews(const Document& document)
{
    for (std::size_t i = 0; i < document.model.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = document.model.bufferViews[i];
        const std::uint64_t size = document.buffers[std::size_t(view.buffer)].size();
        if (view.byteOffset > size || view.byteLength > size - view.byteOffset)
            document.fail(at("bufferViews", i), "reaches past the end of buffer " + std::to_string(view.buffer));
        if (view.byteStride % 4 != 0) document.fail(at("bufferViews", i) + ".byteStride", "must be a multiple of 4");
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
    const auto component = std::uint64_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType)));
    const std::uint64_t size = component * std::uint64_t(tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type)));
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

void checkNodes(const Document& document)
{
    const auto& nodes = document.model.nodes;
    std::vector<int> parent(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (std::size_t c = 0; c < nodes[i].children.size(); ++c) {
            int& p = parent[std::size_t(nodes[i].children[c])];
            if (p >= 0) document.fail(at(at("nodes", i) + ".children", c), "node " + std::to_string(nodes[i].children[c]) + " already has a parent");
            p = int(i);
        }
    }
    // With one parent at most, a node that no root reaches hangs on a loop.
    std::vector<int> open;
    std::size_t reached = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (parent[i] < 0) open.push_back(int(i));
    std::vector<bool> seen(nodes.size(), false);
    while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        seen[std::size_t(node)] = true;
        ++reached;
        for (const int child : nodes[std::size_t(node)].children) open.push_back(child);
    }
    for (std::size_t i = 0; i < nodes.size() && reached < nodes.size(); ++i)
        if (!seen[i]) document.fail(at("nodes", i), "is its own ancestor");

    for (std::size_t s = 0; s < document.model.scenes.size(); ++s) {
        const std::vector<int>& roots = document.model.scenes[s].nodes;
        for (std::size_t r = 0; r < roots.size(); ++r)
            if (parent[std::size_t(roots[r])] >= 0)
                document.fail(at(at("scenes", s) + ".nodes", r), "node " + std::to_string(roots[r]) + " is another node's child");
    }
}

void checkSkins(const Document& document)
{
    for (std::size_t i = 0; i < document.model.skins.size(); ++i) {
        const tinygltf::Skin& skin = document.model.skins[i];
        if (skin.joints.empty()) document.fail(at("skins", i) + ".joints", "is empty");
        if (skin.inverseBindMatrices < 0) continue;
        const tinygltf::Accessor& matrices = document.model.accessors[std::size_t(skin.inverseBindMatrices)];
        const std::string path = at("skins", i) + ".inverseBindMatrices";
        if (matrices.type != TINYGLTF_TYPE_MAT4 || matrices.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) document.fail(path, "must be float MAT4");
        if (matrices.count < skin.joints.size()) document.fail(path, "has fewer matrices than there are joints");
    }
}

}  // namespace

void checkReferences(const Document& document)
{
    checkBufferViews(document);
    for (std::size_t i = 0; i < document.model.accessors.size(); ++i) checkAccessor(document, i);
    checkNodes(document);
    checkSkins(document);
}

}  // namespace lrsm::gltf
