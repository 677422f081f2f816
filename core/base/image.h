#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

namespace lrsm {

/// Owns width x height texels, row 0 at the top, row-major, zero-initialised.
template <class T>
struct Image {
    int width = 0;
    int height = 0;
    std::vector<T> texels;

    Image() = default;
    Image(int w, int h, const T& fill = T{}) : width(w), height(h), texels(std::size_t(w) * std::size_t(h), fill) {}

    T& at(int x, int y) { return texels[index(x, y)]; }
    const T& at(int x, int y) const { return texels[index(x, y)]; }
    std::size_t index(int x, int y) const
    {
        assert(x >= 0 && x < width && y >= 0 && y < height);
        return std::size_t(y) * std::size_t(width) + std::size_t(x);
    }
    std::size_t byteSize() const { return texels.size() * sizeof(T); }
    bool empty() const { return texels.empty(); }
};

}  // namespace lrsm
