#include "core/raster/rasterize.h"

#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/raster/setup.h"
#include "core/raster/tile.h"

#include <cmath>

namespace lrsm {

using namespace raster;

namespace {

std::vector<ScreenVertex> projectVertices(std::span<const Vec4> clipPositions, const Viewport& viewport)
{
    const ClipVolume volume(viewport.width, viewport.height);
    std::vector<ScreenVertex> vertices(clipPositions.size());
    parallelFor(vertices.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec4& p = clipPositions[i];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z) || !std::isfinite(p.w)) {
                vertices[i].outside = kNotFinite;
                continue;
            }
            const std::uint32_t outside = outsideBits(volume, p.x, p.y, p.z, p.w);
            if (!(outside & kMustClip)) vertices[i] = projectVertex(viewport, p.x, p.y, p.z, p.w);
            vertices[i].outside = outside;
        }
    });
    return vertices;
}

}  // namespace

RasterOutput rasterize(const RasterInput& input, int width, int height, std::span<const std::uint8_t> tested, const FragmentTest& test)
{
    if (width < 1 || height < 1 || width > kMaxPictureSize || height > kMaxPictureSize)
        throw InputError("picture size " + std::to_string(width) + "x" + std::to_string(height),
                         "each edge must be 1.." + std::to_string(kMaxPictureSize) + " pixels; choose another size");
    const Viewport viewport{width, height};
    const std::vector<ScreenVertex> vertices = projectVertices(input.clipPositions, viewport);

    // Chunks of consecutive triangles, so that every tile can go through them in submission order.
    const std::size_t count = input.triangles.size();
    std::vector<Chunk> chunks((count + kChunkTriangles - 1) / kChunkTriangles);
    parallelFor(count, kChunkTriangles,
                [&](std::size_t begin, std::size_t end) { chunks[begin / kChunkTriangles] = setUpChunk(input, vertices, viewport, begin, end); });

    RasterOutput output{Image<Fragment>(width, height), {}};
    const std::size_t tiles = std::size_t(viewport.tilesX()) * std::size_t(viewport.tilesY());
    parallelFor(tiles, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t tile = begin; tile < end; ++tile) drawTile(chunks, viewport, static_cast<int>(tile), tested, test, output.fragments);
    });

    for (const Chunk& chunk : chunks) {
        output.counts.submitted += chunk.counts.submitted;
        output.counts.drawn += chunk.counts.drawn;
        output.counts.clipped += chunk.counts.clipped;
        output.counts.culled += chunk.counts.culled;
        output.counts.dropped += chunk.counts.dropped;
    }
    return output;
}

}  // namespace lrsm
