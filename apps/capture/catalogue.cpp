#include "apps/capture/catalogue.h"

namespace lrsm {

Buffer& Catalogue::add(const std::string& name, Dtype dtype, const std::vector<std::size_t>& shape, const Names& axes, const Names& components,
                       const Text& text, const Tolerance& tolerance)
{
    Buffer& buffer = buffers.emplace_back();
    buffer.name = name;
    buffer.pass = pass;
    buffer.dtype = dtype;
    buffer.shape = shape;
    buffer.axes = axes;
    buffer.components = components;
    if (!components.empty()) {
        buffer.shape.push_back(components.size());
        buffer.axes.push_back("component");
    }
    buffer.meaning = text.meaning;
    buffer.space = text.space;
    buffer.unit = text.unit;
    buffer.tolerance = tolerance;
    buffer.file = name + ".npy";
    return buffer;
}

Buffer& Catalogue::picture(const std::string& name, int width, int height, const Names& components, const Text& text, const Tolerance& tolerance, Dtype dtype)
{
    return add(name, dtype, {static_cast<std::size_t>(height), static_cast<std::size_t>(width)}, {"row", "column"}, components, text, tolerance);
}

}  // namespace lrsm
