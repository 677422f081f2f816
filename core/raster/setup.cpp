#include "core/raster/setup.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lrsm::raster {

namespace {

/// Nearest even, independent of instruction set: the sum's last bit has weight 1. |value| < 2^51.
double roundNearestEven(double value)
{
    constexpr double kShift = 0x1.8p52;
    return (value + kShift) - kShift;
}

std::int32_t snap(double pixels)
{
    constexpr double kLimit = (kGuardBandPixels + kMaxPictureSize) * kSubPixels;
    return static_cast<std::int32_t>(roundNearestEven(std::clamp(pixels * kSubPixels, -kLimit, kLimit)));
}

std::int64_t twiceArea(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c)
{
    return std::int64_t(b.x - a.x) * (c.y - a.y) - std::int64_t(c.x - a.x) * (b.y - a.y);
}

enum class Fate { drawn, culled, outside };

/// Culls one piece or appends it to the chunk. `piece`: barycentrics of the corners, or null when they are the submitted vertices.
Fate addPiece(Chunk& chunk, const Viewport& viewport, std::uint32_t triangle, Cull cull, ScreenVertex a, ScreenVertex b, ScreenVertex c, PieceCorners* piece)
{
    // Counter-clockwise in y-up is a negative area in y-down.
    const std::int64_t area = twiceArea(a, b, c);
    if (area == 0 || (area > 0 && cull == Cull::back)) return Fate::culled;
    if (area < 0) {
        std::swap(b, c);
        if (piece) {
            std::swap(piece->b1[1], piece->b1[2]);
            std::swap(piece->b2[1], piece->b2[2]);
        }
    }
    SetupTriangle setup{.x = {a.x, b.x, c.x}, .y = {a.y, b.y, c.y}, .z = {a.z, b.z, c.z}, .invW = {a.invW, b.invW, c.invW}, .triangle = triangle, .corners = 0};
    if (pixelBounds(setup, viewport).empty()) return Fate::outside;

    setup.corners = area < 0 ? kCornersSwapped : kCornersInOrder;
    if (piece) {
        setup.corners = kCornersClipped + static_cast<std::uint32_t>(chunk.corners.size());
        chunk.corners.push_back(*piece);
    }
    chunk.setup.push_back(setup);
    return Fate::drawn;
}

Fate addClipped(Chunk& chunk, const Viewport& viewport, const RasterInput& input, std::uint32_t triangle, Cull cull)
{
    const ClipVolume volume(viewport.width, viewport.height);
    ClipPolygon polygon;
    polygon.count = 3;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec4& p = input.clipPositions[input.triangles[triangle][k]];
        polygon.vertices[k] = {
            .x = p.x, .y = p.y, .z = p.z, .w = p.w, .b1 = k == 1 ? 1.0 : 0.0, .b2 = k == 2 ? 1.0 : 0.0, .outside = outsideBits(volume, p.x, p.y, p.z, p.w)};
    }
    clipPolygon(volume, polygon);
    if (polygon.count == 0) return Fate::outside;

    std::array<ScreenVertex, kMaxClipVertices> screen;
    for (std::size_t k = 0; k < std::size_t(polygon.count); ++k) {
        const ClipVertex& v = polygon.vertices[k];
        screen[k] = projectVertex(viewport, v.x, v.y, v.z, v.w);
    }
    Fate fate = Fate::culled;
    for (std::size_t k = 2; k < std::size_t(polygon.count); ++k) {
        PieceCorners piece;
        const std::array<std::size_t, 3> fan{0, k - 1, k};
        for (std::size_t i = 0; i < 3; ++i) {
            piece.b1[i] = static_cast<float>(polygon.vertices[fan[i]].b1);
            piece.b2[i] = static_cast<float>(polygon.vertices[fan[i]].b2);
        }
        const Fate one = addPiece(chunk, viewport, triangle, cull, screen[0], screen[k - 1], screen[k], &piece);
        if (one == Fate::drawn || (one == Fate::outside && fate == Fate::culled)) fate = one;
    }
    return fate;
}

void addTriangle(Chunk& chunk, const RasterInput& input, const std::vector<ScreenVertex>& vertices, const Viewport& viewport, std::uint32_t triangle)
{
    const auto& index = input.triangles[triangle];
    const ScreenVertex &a = vertices[index[0]], &b = vertices[index[1]], &c = vertices[index[2]];
    const std::uint32_t any = a.outside | b.outside | c.outside, all = a.outside & b.outside & c.outside;

    ++chunk.counts.submitted;
    if (any & kNotFinite) {
        ++chunk.counts.dropped;
        return;
    }
    if (all) return;

    const Cull cull = input.cull.empty() ? Cull::none : input.cull[triangle];
    Fate fate;
    if (any & kMustClip) {
        ++chunk.counts.clipped;
        fate = addClipped(chunk, viewport, input, triangle, cull);
    } else {
        fate = addPiece(chunk, viewport, triangle, cull, a, b, c, nullptr);
    }
    if (fate == Fate::drawn) ++chunk.counts.drawn;
    if (fate == Fate::culled) ++chunk.counts.culled;
}

/// Calls visit(tile) for each tile that the triangle may touch: its bounding box, less the tiles wholly outside an edge.
template <class Visit>
void forEachTile(const SetupTriangle& triangle, const Viewport& viewport, Visit visit)
{
    const PixelBounds box = pixelBounds(triangle, viewport);
    const int tx0 = box.x0 / kTileSize, tx1 = box.x1 / kTileSize, ty0 = box.y0 / kTileSize, ty1 = box.y1 / kTileSize;
    const int columns = viewport.tilesX();
    if (tx0 == tx1 && ty0 == ty1) {
        visit(ty0 * columns + tx0);
        return;
    }
    const std::array<Edge, 3> edges{Edge(triangle, 0), Edge(triangle, 1), Edge(triangle, 2)};
    for (int ty = ty0; ty <= ty1; ++ty)
        for (int tx = tx0; tx <= tx1; ++tx) {
            bool inside = true;
            for (const Edge& edge : edges) {
                // The tile's pixel in which the edge function is largest.
                const int x = tx * kTileSize + (edge.dy < 0 ? kTileSize - 1 : 0), y = ty * kTileSize + (edge.dx > 0 ? kTileSize - 1 : 0);
                inside = inside && edge.atPixel(x, y) + edge.bias() >= 0;
            }
            if (inside) visit(ty * columns + tx);
        }
}

void binIntoTiles(Chunk& chunk, const Viewport& viewport)
{
    const std::size_t tiles = std::size_t(viewport.tilesX()) * std::size_t(viewport.tilesY());
    chunk.tileOffset.assign(tiles + 1, 0);
    for (const SetupTriangle& triangle : chunk.setup) forEachTile(triangle, viewport, [&](int tile) { ++chunk.tileOffset[std::size_t(tile) + 1]; });
    for (std::size_t tile = 0; tile < tiles; ++tile) chunk.tileOffset[tile + 1] += chunk.tileOffset[tile];

    // Filling moves each tile's begin to its end; the shift back by one tile restores the begins.
    chunk.tileItems.resize(chunk.tileOffset[tiles]);
    for (std::size_t i = 0; i < chunk.setup.size(); ++i)
        forEachTile(chunk.setup[i], viewport, [&](int tile) { chunk.tileItems[chunk.tileOffset[std::size_t(tile)]++] = static_cast<std::uint16_t>(i); });
    for (std::size_t tile = tiles; tile > 0; --tile) chunk.tileOffset[tile] = chunk.tileOffset[tile - 1];
    chunk.tileOffset[0] = 0;
}

}  // namespace

ScreenVertex projectVertex(const Viewport& viewport, double x, double y, double z, double w)
{
    const double invW = 1.0 / w;
    const double halfWidth = 0.5 * viewport.width, halfHeight = 0.5 * viewport.height;
    ScreenVertex v;
    v.x = snap(halfWidth + (x * invW) * halfWidth);
    v.y = snap(halfHeight - (y * invW) * halfHeight);
    v.z = static_cast<float>(std::min(z * invW, 1e30));  // finite, whatever comes
    v.invW = static_cast<float>(invW);
    return v;
}

Chunk setUpChunk(const RasterInput& input, const std::vector<ScreenVertex>& vertices, const Viewport& viewport, std::size_t begin, std::size_t end)
{
    Chunk chunk;
    chunk.setup.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) addTriangle(chunk, input, vertices, viewport, static_cast<std::uint32_t>(i));
    binIntoTiles(chunk, viewport);
    return chunk;
}

}  // namespace lrsm::raster
