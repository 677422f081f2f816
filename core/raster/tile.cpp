#include "core/raster/tile.h"

#include <algorithm>
#include <limits>

namespace lrsm::raster {

namespace {

constexpr int kBlock = 8;

/// What the depth test leaves at each pixel of the tile; attributes wait until all is drawn.
struct TileBuffers {
    int x0, y0;
    float depth[kTileSize * kTileSize];
    std::uint32_t chunk[kTileSize * kTileSize];
    std::uint16_t item[kTileSize * kTileSize];
};

/// Barycentrics at a pixel centre, perspective-correct, from the exact edge functions of the snapped triangle.
Fragment resolve(const SetupTriangle& t, const Chunk& chunk, int x, int y, float depth)
{
    double q[3];
    for (int i = 0; i < 3; ++i) q[i] = double(Edge(t, i).atPixel(x, y)) * double(t.invW[std::size_t(i)]);
    const double scale = 1.0 / (q[0] + q[1] + q[2]);
    const double c1 = q[1] * scale, c2 = q[2] * scale;

    Fragment fragment{.triangle = t.triangle, .b1 = float(c1), .b2 = float(c2), .depth = depth};
    if (t.corners == kCornersSwapped) {
        std::swap(fragment.b1, fragment.b2);
    } else if (t.corners >= kCornersClipped) {
        const PieceCorners& p = chunk.corners[t.corners - kCornersClipped];
        const double c0 = q[0] * scale;
        fragment.b1 = float(c0 * p.b1[0] + c1 * p.b1[1] + c2 * p.b1[2]);
        fragment.b2 = float(c0 * p.b2[0] + c1 * p.b2[1] + c2 * p.b2[2]);
    }
    return fragment;
}

/// One triangle in one tile. Coverage steps are 32-bit: a pixel step changes the edge function by a multiple of 256, so its sign is that of
/// floor(E / 256), and within a tile an edge that is neither all in nor all out stays below 2^31 there (guard band).
class TriangleInTile {
  public:
    TriangleInTile(const SetupTriangle& t, const PixelBounds& box) : box_(box)
    {
        const int w = box.x1 - box.x0, h = box.y1 - box.y0;
        for (int i = 0; i < 3; ++i) {
            const Edge edge(t, i);
            value_[i] = edge.atPixel(box.x0, box.y0);
            const std::int64_t start = (value_[i] + edge.bias()) >> 8, stepX = -edge.dy, stepY = edge.dx;
            const std::int64_t low = start + std::min<std::int64_t>(0, stepX * w) + std::min<std::int64_t>(0, stepY * h);
            const std::int64_t high = start + std::max<std::int64_t>(0, stepX * w) + std::max<std::int64_t>(0, stepY * h);
            exactX_[i] = double(stepX * kSubPixels);
            exactY_[i] = double(stepY * kSubPixels);
            empty_ = empty_ || high < 0;
            if (low >= 0 || high < 0) continue;  // all in: zero everywhere
            start_[i] = static_cast<std::int32_t>(start);
            stepX_[i] = static_cast<std::int32_t>(stepX);
            stepY_[i] = static_cast<std::int32_t>(stepY);
        }
        if (empty_) return;

        // depth = z0 + lambda1 (z1 - z0) + lambda2 (z2 - z0), lambda_i = E_i / (2 area), all from exact E_i.
        const Edge edge(t, 0);
        const double twiceArea = double(edge.dx * (t.y[0] - edge.ay) - edge.dy * (t.x[0] - edge.ax));
        z0_ = double(t.z[0]);
        k1_ = (double(t.z[1]) - z0_) / twiceArea;
        k2_ = (double(t.z[2]) - z0_) / twiceArea;
        zMin_ = std::min({t.z[0], t.z[1], t.z[2]});
        zMax_ = std::max({t.z[0], t.z[1], t.z[2]});
    }

    bool empty() const { return empty_; }

    /// Calls keep(x, y, depth) for each covered centre in the box, rows first.
    template <class Keep>
    void draw(Keep keep) const
    {
        const int w = box_.x1 - box_.x0, h = box_.y1 - box_.y0;
        if (w < kBlock && h < kBlock) {
            drawBlock(0, 0, w, h, keep);
            return;
        }
        for (int y = 0; y <= h; y += kBlock)
            for (int x = 0; x <= w; x += kBlock) {
                const int x1 = std::min(x + kBlock - 1, w), y1 = std::min(y + kBlock - 1, h);
                if (!blockOutside(x, y, x1, y1)) drawBlock(x, y, x1, y1, keep);
            }
    }

  private:
    bool blockOutside(int x0, int y0, int x1, int y1) const
    {
        bool outside = false;
        for (int i = 0; i < 3; ++i) outside = outside || start_[i] + stepX_[i] * (stepX_[i] > 0 ? x1 : x0) + stepY_[i] * (stepY_[i] > 0 ? y1 : y0) < 0;
        return outside;
    }

    template <class Keep>
    void drawBlock(int x0, int y0, int x1, int y1, Keep keep) const
    {
        for (int y = y0; y <= y1; ++y) {
            std::int32_t e0 = start_[0] + stepX_[0] * x0 + stepY_[0] * y, e1 = start_[1] + stepX_[1] * x0 + stepY_[1] * y,
                         e2 = start_[2] + stepX_[2] * x0 + stepY_[2] * y;
            for (int x = x0; x <= x1; ++x) {
                if ((e0 | e1 | e2) >= 0) keep(box_.x0 + x, box_.y0 + y, depthAt(x, y));
                e0 += stepX_[0];
                e1 += stepX_[1];
                e2 += stepX_[2];
            }
        }
    }

    float depthAt(int x, int y) const
    {
        const double v1 = double(value_[1]) + (exactX_[1] * x + exactY_[1] * y), v2 = double(value_[2]) + (exactX_[2] * x + exactY_[2] * y);
        return std::clamp(float(z0_ + (v1 * k1_ + v2 * k2_)), zMin_, zMax_);
    }

    PixelBounds box_;
    std::int32_t start_[3] = {}, stepX_[3] = {}, stepY_[3] = {};
    std::int64_t value_[3] = {};
    double exactX_[3] = {}, exactY_[3] = {};
    double z0_ = 0.0, k1_ = 0.0, k2_ = 0.0;
    float zMin_ = 0.0f, zMax_ = 0.0f;
    bool empty_ = false;
};

void drawTriangle(TileBuffers& buffers, const Chunk& chunk, std::uint32_t chunkIndex, std::uint16_t item, const PixelBounds& tileBounds,
                  const Viewport& viewport, bool tested, const FragmentTest& test)
{
    const SetupTriangle& triangle = chunk.setup[item];
    PixelBounds box = pixelBounds(triangle, viewport);
    box = {.x0 = std::max(box.x0, tileBounds.x0),
           .y0 = std::max(box.y0, tileBounds.y0),
           .x1 = std::min(box.x1, tileBounds.x1),
           .y1 = std::min(box.y1, tileBounds.y1)};
    const TriangleInTile inTile(triangle, box);
    if (inTile.empty()) return;
    inTile.draw([&](int x, int y, float depth) {
        const std::size_t i = std::size_t(y - buffers.y0) * kTileSize + std::size_t(x - buffers.x0);
        if (!(depth < buffers.depth[i])) return;
        if (tested && !test(resolve(triangle, chunk, x, y, depth))) return;
        buffers.depth[i] = depth;
        buffers.chunk[i] = chunkIndex;
        buffers.item[i] = item;
    });
}

}  // namespace

void drawTile(const std::vector<Chunk>& chunks, const Viewport& viewport, int tile, std::span<const std::uint8_t> tested, const FragmentTest& test,
              Image<Fragment>& out)
{
    TileBuffers buffers;
    buffers.x0 = tile % viewport.tilesX() * kTileSize;
    buffers.y0 = tile / viewport.tilesX() * kTileSize;
    const PixelBounds bounds{.x0 = buffers.x0,
                             .y0 = buffers.y0,
                             .x1 = std::min(buffers.x0 + kTileSize, viewport.width) - 1,
                             .y1 = std::min(buffers.y0 + kTileSize, viewport.height) - 1};
    // No far clip: any finite depth is nearer than nothing.
    std::fill(std::begin(buffers.depth), std::end(buffers.depth), std::numeric_limits<float>::infinity());

    bool any = false;
    for (std::size_t c = 0; c < chunks.size(); ++c) {
        const Chunk& chunk = chunks[c];
        for (std::uint32_t k = chunk.tileOffset[std::size_t(tile)]; k < chunk.tileOffset[std::size_t(tile) + 1]; ++k) {
            const std::uint16_t item = chunk.tileItems[k];
            const bool isTested = !tested.empty() && tested[chunk.setup[item].triangle];
            drawTriangle(buffers, chunk, static_cast<std::uint32_t>(c), item, bounds, viewport, isTested, test);
            any = true;
        }
    }
    if (!any) return;

    for (int y = bounds.y0; y <= bounds.y1; ++y)
        for (int x = bounds.x0; x <= bounds.x1; ++x) {
            const std::size_t i = std::size_t(y - buffers.y0) * kTileSize + std::size_t(x - buffers.x0);
            if (buffers.depth[i] == std::numeric_limits<float>::infinity()) continue;
            const Chunk& chunk = chunks[buffers.chunk[i]];
            out.at(x, y) = resolve(chunk.setup[buffers.item[i]], chunk, x, y, buffers.depth[i]);
        }
}

}  // namespace lrsm::raster
