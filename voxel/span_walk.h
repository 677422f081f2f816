#pragma once

#include "core/settings/settings.h"
#include "voxel/fixed_triangle.h"

#include <algorithm>
#include <array>
#include <cstdint>

/// One projection of the overlap test: which cells of a 2D grid does a triangle touch, row by row, in integers.
/// Schwarz and Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", SIGGRAPH Asia 2010, Sec. 4: a triangle overlaps a box when
/// their bounds overlap, the triangle's plane meets the box, and in each of the three projections every edge's half-plane meets the
/// box's rectangle. For a given row an edge's inequality is one bound on the column, so a row's cells are one interval.
namespace lrsm {

inline constexpr std::int64_t floorDiv(std::int64_t n, std::int64_t d)  // d > 0
{
    const std::int64_t q = n / d;
    return q - (n % d < 0);
}
inline constexpr std::int64_t floorHalf(std::int64_t n)
{
    return n >> 1;
}
inline constexpr std::int64_t ceilHalf(std::int64_t n)
{
    return -((-n) >> 1);
}
inline constexpr std::int64_t floorVoxel(std::int64_t n)
{
    return n >> kVoxelFractionBits;
}
inline constexpr std::int64_t ceilVoxel(std::int64_t n)
{
    return -((-n) >> kVoxelFractionBits);
}

/// Closed interval of cells; lo > hi is empty.
struct Span {
    int lo = 0, hi = -1;
    bool empty() const { return lo > hi; }
};
inline Span intersect(Span a, Span b)
{
    return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

/// Cells whose closed extent touches [low, high] (1/4096 voxel) along one axis, cut to the grid.
inline Span touchedCells(std::int32_t low, std::int32_t high, int resolution)
{
    return {std::max(int(ceilVoxel(low)) - 1, 0), std::min(int(floorVoxel(high)), resolution - 1)};
}

/// floor((n + step k) / d) for k = 0, 1, 2 ... with one division at the start and one for the slope.
class FloorWalk {
  public:
    FloorWalk() = default;
    FloorWalk(std::int64_t n, std::int64_t step, std::int64_t d) : d_(d)
    {
        q_ = floorDiv(n, d);
        r_ = n - q_ * d;
        stepQ_ = floorDiv(step, d);
        stepR_ = step - stepQ_ * d;
    }
    std::int64_t value() const { return q_; }
    void next()
    {
        q_ += stepQ_;
        r_ += stepR_;
        const bool carry = r_ >= d_;
        q_ += carry;
        r_ -= carry ? d_ : 0;
    }

  private:
    std::int64_t q_ = 0, r_ = 0, stepQ_ = 0, stepR_ = 0, d_ = 1;
};

/// Cell (i, j) passes where a i + b j >= c.
struct HalfPlane {
    std::int64_t a, b, c;
};

/// The half-plane of the edge p -> q whose inside is to its left (orientation 1) or right (-1), as a test on cells:
/// conservative: some point of the closed cell is inside; thin: some point of the diamond between the cell's edge midpoints is;
/// raster: the cell's centre is, with the top-left rule on the line itself (i to the right, j down).
template <Voxelization mode>
inline HalfPlane edgeHalfPlane(const std::int64_t (&p)[2], const std::int64_t (&q)[2], int orientation)
{
    const std::int64_t a = orientation * (p[1] - q[1]);
    const std::int64_t b = orientation * (q[0] - p[0]);
    const std::int64_t d = a * p[0] + b * p[1];  // inside: a x + b y >= d, all in 1/4096 voxel
    if constexpr (mode == Voxelization::conservative) {
        return {a, b, ceilVoxel(d) - std::max<std::int64_t>(a, 0) - std::max<std::int64_t>(b, 0)};
    } else if constexpr (mode == Voxelization::thin) {
        return {a, b, ceilHalf(ceilVoxel(2 * d) - a - b - std::max(std::abs(a), std::abs(b)))};
    } else {
        const bool topOrLeft = a > 0 || (a == 0 && b > 0);
        return {a, b, ceilHalf((topOrLeft ? ceilVoxel(2 * d) : floorVoxel(2 * d) + 1) - a - b)};
    }
}

/// The cells of one row after the other, for a triangle projected to (column axis, row axis).
template <Voxelization mode>
class SpanWalk {
  public:
    SpanWalk(const FixedTriangle& triangle, std::size_t columnAxis, std::size_t rowAxis, Span columns, int firstRow) : columns_(columns)
    {
        std::int64_t p[3][2];
        for (std::size_t k = 0; k < 3; ++k) {
            p[k][0] = triangle.vertex[k][columnAxis];
            p[k][1] = triangle.vertex[k][rowAxis];
        }
        const std::int64_t area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
        // Seen edge-on the triangle is a segment. Going round it passes the segment both ways, so both of its sides bound all the same.
        for (std::size_t k = 0; k < 3; ++k) add(edgeHalfPlane<mode>(p[k], p[(k + 1) % 3], area >= 0 ? 1 : -1), firstRow);
        row_ = firstRow;
    }

    Span current() const
    {
        if (row_ < rowLo_ || row_ > rowHi_) return {};
        std::int64_t lo = columns_.lo, hi = columns_.hi;
        for (int k = 0; k < lowers_; ++k) lo = std::max(lo, lower_[std::size_t(k)].value());
        for (int k = 0; k < uppers_; ++k) hi = std::min(hi, upper_[std::size_t(k)].value());
        if (lo > hi) return {};
        return {int(lo), int(hi)};
    }

    void next()
    {
        ++row_;
        for (int k = 0; k < lowers_; ++k) lower_[std::size_t(k)].next();
        for (int k = 0; k < uppers_; ++k) upper_[std::size_t(k)].next();
    }

  private:
    void add(const HalfPlane& h, std::int64_t row)
    {
        if (h.a > 0)
            lower_[std::size_t(lowers_++)] = FloorWalk(h.c - h.b * row + h.a - 1, -h.b, h.a);
        else if (h.a < 0)
            upper_[std::size_t(uppers_++)] = FloorWalk(h.b * row - h.c, h.b, -h.a);
        else if (h.b > 0)
            rowLo_ = std::max(rowLo_, -floorDiv(-h.c, h.b));
        else if (h.b < 0)
            rowHi_ = std::min(rowHi_, floorDiv(-h.c, -h.b));
        else if (h.c > 0)
            rowHi_ = std::numeric_limits<std::int64_t>::min();  // raster: a zero-length edge holds no sample
    }

    Span columns_;
    std::int64_t row_ = 0;
    std::int64_t rowLo_ = std::numeric_limits<std::int64_t>::min();
    std::int64_t rowHi_ = std::numeric_limits<std::int64_t>::max();
    std::array<FloorWalk, 3> lower_, upper_;
    int lowers_ = 0, uppers_ = 0;
};

}  // namespace lrsm
