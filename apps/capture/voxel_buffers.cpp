#include "apps/capture/voxel_buffers.h"

#include "apps/capture/fill.h"
#include "apps/capture/tolerances.h"

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

}  // namespace

void describeBits(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const int resolution = frame.settings.voxel.resolution;
    const auto n = static_cast<std::size_t>(resolution), bricks = static_cast<std::size_t>(BitGrid::bricksPerEdge(resolution));
    Buffer& bits = out.add("voxel.bits", Dtype::u1, {n, n, (n + 7) / 8}, {"z", "y", "x_byte"}, {}, {"occupied voxels: bit x & 7 of byte x >> 3", "grid", ""},
                           tolerances::kVoxels);
    bits.encoding = Encoding::bits;
    bits.dds = DdsPlace{"voxel.dds", 0, DxgiFormat::R8_UNORM, true};
    Buffer& words = out.add("voxel.bricks", Dtype::u8, {bricks, bricks, bricks}, {"brick_z", "brick_y", "brick_x"}, {},
                            {"the same, 4x4x4 voxels a word: bit (x & 3) + 4 (y & 3) + 16 (z & 3)", "grid", ""}, tolerances::kVoxels);
    words.encoding = Encoding::bits;
}

void describeVoxelMips(Catalogue& out, const DescribedFrame& frame, std::size_t)
{
    const VoxelSettings& settings = frame.settings.voxel;
    const bool directional = settings.axes == OpacityAxes::directional, unorm = settings.storage == Storage::gpu;
    const DxgiFormat format =
        unorm ? (directional ? DxgiFormat::R8G8B8A8_UNORM : DxgiFormat::R8_UNORM) : (directional ? DxgiFormat::R32G32B32A32_FLOAT : DxgiFormat::R32_FLOAT);
    for (std::uint32_t level = 1; settings.resolution >> level >= 1; ++level) {
        const auto n = static_cast<std::size_t>(settings.resolution >> level);
        Buffer& mip = out.add(mipName("voxel", static_cast<int>(level)), unorm ? Dtype::u1 : Dtype::f4, {n, n, n}, {"z", "y", "x"},
                              directional ? Catalogue::Names{"x", "y", "z"} : Catalogue::Names{},
                              {directional ? "share of columns along the axis that are covered" : "opacity", "grid", ""}, tolerances::voxelMip(unorm));
        if (unorm) mip.encoding = Encoding::unorm;
        // One value a texel continues the base level's texture; three need a texture of their own.
        const bool oneChain = unorm && !directional;
        mip.dds = oneChain ? DdsPlace{"voxel.dds", level, format, true} : DdsPlace{"voxel.mips.dds", level - 1, format, true};
    }
}

void toBuffers(const BitGrid& grid, std::vector<Buffer>& buffers)
{
    if (Buffer* bits = findBuffer(buffers, "voxel.bits")) unpackRows(grid, *bits);
    copyTo(buffers, "voxel.bricks", grid.bricks);
}

void toBuffers(const OpacityPyramid& opacity, std::vector<Buffer>& buffers)
{
    for (int level = 1; level < opacity.levels(); ++level) {
        Buffer* buffer = findBuffer(buffers, mipName("voxel", level));
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
            const auto from = valuesOf<T>(capture, mipName("voxel", level), dtype, values);
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
