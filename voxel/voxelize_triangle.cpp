#include "voxel/voxelize_triangle.h"

#include <atomic>
#include <cassert>
#include <utility>

namespace lrsm {
namespace {

__extension__ using Int128 = __int128;

Int128 floorVoxel128(Int128 n)
{
    return n >> kVoxelFractionBits;
}
Int128 ceilVoxel128(Int128 n)
{
    return -((-n) >> kVoxelFractionBits);
}
Int128 floorHalf128(Int128 n)
{
    return n >> 1;
}
Int128 ceilHalf128(Int128 n)
{
    return -((-n) >> 1);
}

struct QuotientRemainder {
    std::int64_t quotient, remainder;
};

/// Floor, d > 0. n / d is the plane's depth at a column that the triangle touches, so it lies within a few voxels of the triangle's own
/// depths, |depth| <= 2^12 voxels; d, a normal's component, is at most (2^25)^2. Hence |n| < 2^63.
QuotientRemainder divide(Int128 n, std::int64_t d)
{
    assert(n == Int128(std::int64_t(n)));
    const std::int64_t q = floorDiv(std::int64_t(n), d);
    return {q, std::int64_t(n) - q * d};
}

/// Plane test: voxel (i, j, k) passes where low <= n . (i, j, k) <= high.
struct PlaneSlab {
    Int128 low, high;
};

template <Voxelization mode>
PlaneSlab planeSlab(const TriangleSetup& t)
{
    const auto& n = t.normal;
    const auto& v = t.triangle.vertex[0];
    const Int128 d = Int128(n[0]) * v[0] + Int128(n[1]) * v[1] + Int128(n[2]) * v[2];
    const std::int64_t sum = n[0] + n[1] + n[2];
    if constexpr (mode == Voxelization::conservative) {
        // Nearest and farthest corner of the box on either side of the plane.
        std::int64_t positive = 0;
        for (const std::int64_t c : n) positive += std::max<std::int64_t>(c, 0);
        return {ceilVoxel128(d) - positive, floorVoxel128(d) - (sum - positive)};
    } else if constexpr (mode == Voxelization::thin) {
        // The segment along the dominant axis between the box's face centres.
        const std::int64_t half = n[t.depthAxis];
        return {ceilHalf128(ceilVoxel128(2 * d) - sum - half), floorHalf128(floorVoxel128(2 * d) - sum + half)};
    } else {
        // Depth at the centre of the column; voxelizeRows takes the floor.
        const Int128 centre = floorHalf128(floorVoxel128(2 * d) - n[t.columnAxis] - n[t.rowAxis]);
        return {centre, centre};
    }
}

/// floor(n / d) while n falls by `slope` a step, |slope| <= d.
struct DepthWalk {
    std::int64_t q, r;
    DepthWalk(const QuotientRemainder& start) : q(start.quotient), r(start.remainder) {}
    DepthWalk advanced(std::int64_t by, std::int64_t d) const  // for |by| of a few d
    {
        DepthWalk w = *this;
        w.r += by;
        for (; w.r >= d; w.r -= d) ++w.q;
        for (; w.r < 0; w.r += d) --w.q;
        return w;
    }
    void next(std::int64_t slope, std::int64_t d)
    {
        r -= slope;
        const std::int64_t borrow = -std::int64_t(r < 0);
        const std::int64_t carry = -std::int64_t(r >= d);
        q += borrow - carry;
        r += (borrow & d) - (carry & d);
    }
};

/// Gathers the voxels of one brick before `visit(brick, mask)` is told of them.
template <class Visit>
class BrickGatherer {
  public:
    explicit BrickGatherer(const Visit& visit) : visit_(visit) {}
    ~BrickGatherer() { flush(); }
    BrickGatherer(const BrickGatherer&) = delete;
    BrickGatherer& operator=(const BrickGatherer&) = delete;

    void add(std::size_t brick, std::uint64_t mask)
    {
        if (brick != brick_) {
            flush();
            brick_ = brick;
            mask_ = 0;
        }
        mask_ |= mask;
    }

  private:
    void flush()
    {
        if (mask_ != 0) visit_(brick_, mask_);
    }

    const Visit& visit_;
    std::size_t brick_ = 0;
    std::uint64_t mask_ = 0;
};

// Bits 0..k along an axis of a brick: bit strides 1, 4, 16.
constexpr std::uint64_t kRun[3][4] = {{0x1, 0x3, 0x7, 0xF}, {0x1, 0x11, 0x111, 0x1111}, {0x1, 0x10001, 0x100010001, 0x1000100010001}};

template <class Gatherer>
void setColumn(Gatherer& writer, std::size_t brickBase, int bitBase, std::size_t depthAxis, std::size_t brickStride, Span depth)
{
    const int shift = 2 * int(depthAxis);
    for (int k = depth.lo; k <= depth.hi; k = (k | 3) + 1) {
        const int last = std::min(k | 3, depth.hi);
        const std::uint64_t run = kRun[depthAxis][last - k] << ((k & 3) << shift);
        writer.add(brickBase + std::size_t(k >> 2) * brickStride, run << bitBase);
    }
}

constexpr int kMaxResolution = 2048;

template <Voxelization mode, class Visit>
void visitRowsAs(const TriangleSetup& t, Span rows, int resolution, const Visit& visit)
{
    const std::size_t u = t.columnAxis, v = t.rowAxis, w = t.depthAxis;
    const Span columns = t.cells[u], depths = t.cells[w];
    constexpr bool overlap = mode != Voxelization::raster;  // raster looks at one projection only

    const std::size_t edge = std::size_t(BitGrid::bricksPerEdge(resolution));
    const std::size_t stride[3] = {1, edge, edge * edge};
    BrickGatherer<Visit> writer(visit);
    if (t.boxIsExact) {
        for (int j = rows.lo; j <= rows.hi; ++j)
            for (int i = columns.lo; i <= columns.hi; ++i)
                setColumn(writer, std::size_t(j >> 2) * stride[v] + std::size_t(i >> 2) * stride[u], ((j & 3) << (2 * v)) + ((i & 3) << (2 * u)), w, stride[w],
                          depths);
        return;
    }

    // The (depth, column) projection bounds the depth by the column alone: once for all rows.
    std::array<Span, kMaxResolution> depthOfColumn;
    if constexpr (overlap) {
        SpanWalk<mode> walk(t.triangle, w, u, depths, columns.lo);
        for (int i = columns.lo; i <= columns.hi; ++i, walk.next()) depthOfColumn[std::size_t(i - columns.lo)] = walk.current();
    }

    const PlaneSlab slab = planeSlab<mode>(t);
    const std::int64_t nu = t.normal[u], nv = t.normal[v], nw = t.normal[w];
    SpanWalk<mode> columnWalk(t.triangle, u, v, columns, rows.lo);
    SpanWalk<mode> depthWalk(t.triangle, w, v, depths, rows.lo);
    const auto gap = std::int64_t(slab.high - slab.low) - (nw - 1);  // between the two numerators below, at most 3 nw

    for (int j = rows.lo; j <= rows.hi; ++j, columnWalk.next(), depthWalk.next()) {
        const Span inRow = columnWalk.current();
        const Span depthOfRow = overlap ? depthWalk.current() : depths;
        if (inRow.empty() || depthOfRow.empty()) continue;

        // Plane: ceil((low - nu i - nv j) / nw) <= k <= floor((high - nu i - nv j) / nw). A degenerate triangle has no plane.
        DepthWalk low({0, 0}), high({0, 0});
        if (nw > 0) {
            const Int128 along = Int128(nu) * inRow.lo + Int128(nv) * j;
            if constexpr (overlap) {
                low = divide(slab.low - along + (nw - 1), nw);
                high = low.advanced(gap, nw);
            } else {
                low = high = divide(slab.high - along, nw);
            }
        }
        const std::size_t rowBase = std::size_t(j >> 2) * stride[v];
        const int rowBit = (j & 3) << (2 * v);
        for (int i = inRow.lo; i <= inRow.hi; ++i) {
            Span depth = depthOfRow;
            if constexpr (overlap) depth = intersect(depth, depthOfColumn[std::size_t(i - columns.lo)]);
            if (nw > 0) {
                depth.lo = int(std::max<std::int64_t>(depth.lo, low.q));
                depth.hi = int(std::min<std::int64_t>(depth.hi, high.q));
                low.next(nu, nw);
                high.next(nu, nw);
            }
            setColumn(writer, rowBase + std::size_t(i >> 2) * stride[u], rowBit + ((i & 3) << (2 * u)), w, stride[w], depth);
        }
    }
}

template <class Visit>
void visitRows(const TriangleSetup& setup, Span rows, Voxelization mode, int resolution, const Visit& visit)
{
    switch (mode) {
    case Voxelization::conservative: return visitRowsAs<Voxelization::conservative>(setup, rows, resolution, visit);
    case Voxelization::thin: return visitRowsAs<Voxelization::thin>(setup, rows, resolution, visit);
    case Voxelization::raster: return visitRowsAs<Voxelization::raster>(setup, rows, resolution, visit);
    }
}

}  // namespace

TriangleSetup setUpTriangle(const FixedTriangle& triangle, int resolution, Voxelization mode)
{
    TriangleSetup t;
    t.triangle = triangle;
    std::array<std::int64_t, 3> e1, e2, extent;
    int singleCells = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax({triangle.vertex[0][axis], triangle.vertex[1][axis], triangle.vertex[2][axis]});
        t.cells[axis] = touchedCells(low, high, resolution);
        if (t.cells[axis].empty()) return t;
        singleCells += ceilVoxel(low) - 1 == floorVoxel(high);
        e1[axis] = triangle.vertex[1][axis] - triangle.vertex[0][axis];
        e2[axis] = triangle.vertex[2][axis] - triangle.vertex[0][axis];
        extent[axis] = high - low;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
        t.normal[axis] = e1[y] * e2[z] - e1[z] * e2[y];
    }
    const bool degenerate = t.normal[0] == 0 && t.normal[1] == 0 && t.normal[2] == 0;
    if (degenerate && mode == Voxelization::raster) return t;

    // Depth along the normal's longest component; a segment's along its longest extent. Ties: z, then y.
    const auto longest = [](const std::array<std::int64_t, 3>& c) {
        const std::int64_t x = std::abs(c[0]), y = std::abs(c[1]), z = std::abs(c[2]);
        return z >= x && z >= y ? std::size_t(2) : y >= x ? std::size_t(1) : std::size_t(0);
    };
    t.depthAxis = longest(degenerate ? extent : t.normal);
    t.columnAxis = t.depthAxis == 0 ? 1 : 0;
    t.rowAxis = t.depthAxis == 2 ? 1 : 2;
    if (t.normal[t.depthAxis] < 0)
        for (std::int64_t& c : t.normal) c = -c;
    // Within one cell along two axes the triangle, being connected, touches every cell along the third.
    t.boxIsExact = mode == Voxelization::conservative && singleCells >= 2;
    t.empty = false;
    return t;
}

void voxelizeRows(const TriangleSetup& setup, Span rows, Voxelization mode, BitGrid& bits)
{
    visitRows(setup, rows, mode, bits.grid.resolution, [&](std::size_t brick, std::uint64_t mask) {
        const std::atomic_ref<std::uint64_t> word(bits.bricks[brick]);
        if ((word.load(std::memory_order_relaxed) & mask) != mask) word.fetch_or(mask, std::memory_order_relaxed);
    });
}

void forEachBrick(const TriangleSetup& setup, Span rows, Voxelization mode, int resolution, const BrickVisitor& visit)
{
    visitRows(setup, rows, mode, resolution, visit);
}

}  // namespace lrsm
