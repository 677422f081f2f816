#pragma once

#include "conetrace/frame/tiles.h"

#include <algorithm>
#include <cstddef>

namespace lrsm {

/// Blocks of a picture, each spoken for by the pixel in its middle. Where the last one is cut by the picture's edge, its pixel is the last there is.
struct Blocks {
    int width = 0, height = 0, divisor = 1;

    int columns() const { return tilesAlong(width, divisor); }
    int rows() const { return tilesAlong(height, divisor); }
    int middle(int block, int size) const { return std::min(block * divisor + divisor / 2, size - 1); }
    std::size_t pixel(int column, int row) const { return std::size_t(middle(row, height)) * std::size_t(width) + std::size_t(middle(column, width)); }
};

/// The block before a coordinate, and how far it lies on the way to the next one, 0..1.
struct Between {
    int first = 0, second = 0;
    float fraction = 0.0f;
};
inline Between between(const Blocks& blocks, int at, int count, int size)
{
    const int first = std::clamp((at - blocks.divisor / 2) / blocks.divisor, 0, count - 1), second = std::min(first + 1, count - 1);
    const int begin = blocks.middle(first, size), end = blocks.middle(second, size);
    return {first, second, end > begin ? std::clamp(float(at - begin) / float(end - begin), 0.0f, 1.0f) : 0.0f};
}

}  // namespace lrsm
