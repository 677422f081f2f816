#pragma once

#include "core/raster/clip.h"
#include "core/raster/rasterize.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

/// From clip-space vertices to triangles on the 1/256 pixel grid, binned into tiles (internal to the rasterizer).
namespace lrsm::raster {

inline constexpr int kSubPixels = 256;        ///< grid steps a pixel
inline constexpr int kTileSize = 64;          ///< pixels
inline constexpr int kChunkTriangles = 4096;  ///< triangles set up by one task; pieces of a chunk are counted in 16 bits

/// A vertex on the screen. Only valid when none of kMustClip | kNotFinite is set.
struct ScreenVertex {
    std::int32_t x = 0, y = 0;  ///< 1/256 pixel, y down
    float z = 0.0f;             ///< z/w
    float invW = 1.0f;
    std::uint32_t outside = 0;
};

struct Viewport {
    int width = 0, height = 0;
    int tilesX() const { return (width + kTileSize - 1) / kTileSize; }
    int tilesY() const { return (height + kTileSize - 1) / kTileSize; }
};

ScreenVertex projectVertex(const Viewport& viewport, double x, double y, double z, double w);

/// One triangle ready for the tiles: positive area in y-down coordinates, snapped.
struct SetupTriangle {
    std::array<std::int32_t, 3> x{}, y{};
    std::array<float, 3> z{}, invW{};
    std::uint32_t triangle = kNoTriangle;  ///< as submitted
    std::uint32_t corners = 0;             ///< kCornersInOrder, kCornersSwapped, or kCornersClipped + index into Chunk::corners
};
inline constexpr std::uint32_t kCornersInOrder = 0;  ///< corners are the submitted vertices 0, 1, 2
inline constexpr std::uint32_t kCornersSwapped = 1;  ///< 0, 2, 1
inline constexpr std::uint32_t kCornersClipped = 2;

/// Barycentrics of a clipped piece's corners in the submitted triangle.
struct PieceCorners {
    std::array<float, 3> b1{}, b2{};
};

/// Pixels whose centres can be covered, inclusive; empty when x1 < x0 or y1 < y0.
struct PixelBounds {
    int x0 = 0, y0 = 0, x1 = -1, y1 = -1;
    bool empty() const { return x1 < x0 || y1 < y0; }
};
inline PixelBounds pixelBounds(const SetupTriangle& t, const Viewport& viewport)
{
    // First centre at or right of the minimum, last at or left of the maximum; centres are at +0.5.
    constexpr int kHalf = kSubPixels / 2, kShift = 8;
    static_assert(1 << kShift == kSubPixels);
    const auto first = [](const std::array<std::int32_t, 3>& v) { return (std::min(std::min(v[0], v[1]), v[2]) + kHalf - 1) >> kShift; };
    const auto last = [](const std::array<std::int32_t, 3>& v) { return (std::max(std::max(v[0], v[1]), v[2]) - kHalf) >> kShift; };
    return {.x0 = std::max(0, first(t.x)),
            .y0 = std::max(0, first(t.y)),
            .x1 = std::min(viewport.width - 1, last(t.x)),
            .y1 = std::min(viewport.height - 1, last(t.y))};
}

/// Edge i lies opposite corner i. value(x, y) >= 0 inside (exact, in 1/256 pixel squared), plus `bias` for the top-left rule.
struct Edge {
    std::int64_t ax = 0, ay = 0, dx = 0, dy = 0;
    Edge(const SetupTriangle& t, int i)
    {
        const std::size_t a = std::size_t((i + 1) % 3), b = std::size_t((i + 2) % 3);
        ax = t.x[a];
        ay = t.y[a];
        dx = t.x[b] - ax;
        dy = t.y[b] - ay;
    }
    /// At the centre of pixel (x, y).
    std::int64_t atPixel(int x, int y) const
    {
        const std::int64_t px = std::int64_t(x) * kSubPixels + kSubPixels / 2, py = std::int64_t(y) * kSubPixels + kSubPixels / 2;
        return dx * (py - ay) - dy * (px - ax);
    }
    /// A centre on the edge belongs to the triangle on whose left or top the edge is.
    std::int64_t bias() const { return dy < 0 || (dy == 0 && dx > 0) ? 0 : -1; }
};

/// The work of one task: consecutive triangles, in submission order.
struct Chunk {
    std::vector<SetupTriangle> setup;
    std::vector<PieceCorners> corners;
    std::vector<std::uint32_t> tileOffset;  ///< tiles + 1 entries into tileItems
    std::vector<std::uint16_t> tileItems;   ///< indices into setup, ascending in each tile
    RasterCounts counts;
};

/// Clips, culls, sets up and bins triangles [begin, end).
Chunk setUpChunk(const RasterInput& input, const std::vector<ScreenVertex>& vertices, const Viewport& viewport, std::size_t begin, std::size_t end);

}  // namespace lrsm::raster
