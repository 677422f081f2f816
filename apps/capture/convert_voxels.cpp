#include "apps/capture/convert.h"
#include "apps/capture/fill.h"

#include <algorithm>

namespace lrsm {

namespace {

/// Rows of voxels along x, one bit each, from bricks.
void unpackRows(const BitGrid& bits, Buffer& buffer)
{
    auto* to = allocate<std::uint8_t>(buffer);
    const int n = bits.grid.resolution;
    const std::size_t rowBytes = buffer.shape[2];
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y, to += rowBytes)
            for (int x = 0; x < n; x += 4) {
                const std::uint64_t brick = bits.bricks[bits.brickIndex(x, y, z)];
                const auto four = static_cast<unsigned>(brick >> BitGrid::bitIndex(0, y, z)) & 15u;
                to[x / 8] = static_cast<std::uint8_t>(to[x / 8] | four << (x & 7));
            }
}

std::string mipName(int level)
{
    return "voxel.mip" + std::to_string(level);
}

}  // namespace

void toBuffers(const OpacityPyramid& opacity, std::vector<Buffer>& buffers)
{
    if (Buffer* bits = findBuffer(buffers, "voxel.bits")) unpackRows(opacity.base, *bits);
    copyTo(buffers, "voxel.bricks", opacity.base.bricks);
    for (int level = 1; level < opacity.levels(); ++level) {
        Buffer* buffer = findBuffer(buffers, mipName(level));
        if (!buffer) continue;
        const std::size_t first = opacity.texelIndex(level, 0, 0, 0) * static_cast<std::size_t>(opacity.channels());
        buffer->bytes.resize(buffer->elements() * sizeOf(buffer->dtype));
        if (opacity.storage == Storage::gpu)
            std::memcpy(buffer->bytes.data(), opacity.unorm8.data() + first, buffer->bytes.size());
        else
            std::memcpy(buffer->bytes.data(), opacity.float32.data() + first, buffer->bytes.size());
    }
}

BitGrid bitsFromCapture(const Capture& capture)
{
    BitGrid bits;
    bits.grid = capture.grid;
    const int n = bits.grid.resolution;
    const auto edge = static_cast<std::size_t>(BitGrid::bricksPerEdge(n)), rowBytes = static_cast<std::size_t>(n + 7) / 8;
    if (!capture.find("voxel.bits")) {
        bits.bricks = copyFrom<std::uint64_t>(capture, "voxel.bricks", Dtype::u8, edge * edge * edge);
        return bits;
    }
    // The plain rows count where both are given: they are what other programs write.
    const auto rows = valuesOf<std::uint8_t>(capture, "voxel.bits", Dtype::u1, static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * rowBytes);
    bits.bricks.assign(edge * edge * edge, 0);
    std::size_t row = 0;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y, row += rowBytes)
            for (int x = 0; x < n; x += 4) {
                const auto inGrid = n < 4 ? (1u << n) - 1u : 15u;
                const std::uint64_t four = static_cast<unsigned>(rows[row + static_cast<std::size_t>(x / 8)] >> (x & 7)) & inGrid;
                bits.bricks[bits.brickIndex(x, y, z)] |= four << BitGrid::bitIndex(0, y, z);
            }
    return bits;
}

OpacityPyramid opacityFromCapture(const Capture& capture)
{
    OpacityPyramid opacity = buildPyramid(bitsFromCapture(capture), capture.settings.voxel);
    bool follows = true;  // do the captured mips follow from the captured bits?
    for (int level = 1; level < opacity.levels(); ++level) {
        const auto n = static_cast<std::size_t>(opacity.resolutionAt(level)), values = n * n * n * static_cast<std::size_t>(opacity.channels());
        const std::size_t first = opacity.texelIndex(level, 0, 0, 0) * static_cast<std::size_t>(opacity.channels());
        const auto take = [&]<class T>(std::vector<T>& into, Dtype dtype) {
            const auto from = valuesOf<T>(capture, mipName(level), dtype, values);
            const auto to = std::span(into).subspan(first, values);
            if (std::equal(from.begin(), from.end(), to.begin())) return;
            follows = false;
            std::copy(from.begin(), from.end(), to.begin());
        };
        if (opacity.storage == Storage::gpu)
            take(opacity.unorm8, Dtype::u1);
        else
            take(opacity.float32, Dtype::f4);
    }
    // The sampler's knowledge of empty places comes from the bits; where the mips say otherwise they must be read.
    if (!follows) std::fill(opacity.emptyLevels.begin(), opacity.emptyLevels.end(), std::uint8_t(0));
    return opacity;
}

}  // namespace lrsm
