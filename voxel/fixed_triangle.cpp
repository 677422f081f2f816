#include "voxel/fixed_triangle.h"

namespace lrsm {
namespace {

using Point = std::array<double, 3>;  // voxels

// A convex polygon gains at most one corner a cut, 9 in all; the spare places are for what rounding may do to convexity.
struct Polygon {
    std::array<Point, kMaxPieces + 2> corner;
    int count = 0;
    void push(const Point& p)
    {
        if (count < kMaxPieces + 2) corner[std::size_t(count++)] = p;
    }
};

std::int32_t snap(double voxels)
{
    return std::int32_t(std::floor(voxels * double(1 << kVoxelFractionBits) + 0.5));
}

FixedTriangle snapped(const Point& a, const Point& b, const Point& c)
{
    FixedTriangle triangle;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        triangle.vertex[0][axis] = snap(a[axis]);
        triangle.vertex[1][axis] = snap(b[axis]);
        triangle.vertex[2][axis] = snap(c[axis]);
    }
    return triangle;
}

// Keeps sign * (p[axis] - bound) <= 0 (Sutherland and Hodgman 1974, one side).
Polygon cut(const Polygon& in, std::size_t axis, double sign, double bound)
{
    Polygon out;
    for (int k = 0; k < in.count; ++k) {
        const Point& p = in.corner[std::size_t(k)];
        const Point& q = in.corner[std::size_t((k + 1) % in.count)];
        const double dp = sign * (p[axis] - bound);
        const double dq = sign * (q[axis] - bound);
        if (dp <= 0.0) out.push(p);
        if ((dp < 0.0 && dq > 0.0) || (dp > 0.0 && dq < 0.0)) {
            const double t = dp / (dp - dq);
            Point crossing;
            for (std::size_t i = 0; i < 3; ++i) crossing[i] = p[i] + t * (q[i] - p[i]);
            crossing[axis] = bound;
            out.push(crossing);
        }
    }
    return out;
}

}  // namespace

FixedPieces fixedFromWorld(const Vec3& a, const Vec3& b, const Vec3& c, const VoxelGrid& grid)
{
    FixedPieces pieces;
    if (!isFinite(a) || !isFinite(b) || !isFinite(c)) return pieces;

    const double scale = 1.0 / double(grid.voxelSize);
    constexpr double limit = 4096.0;
    Polygon polygon;
    bool near = true;
    for (const Vec3* p : {&a, &b, &c}) {
        Point voxels;
        for (int axis = 0; axis < 3; ++axis) {
            voxels[std::size_t(axis)] = (double((*p)[axis]) - double(grid.origin[axis])) * scale;
            near = near && std::abs(voxels[std::size_t(axis)]) < limit;
        }
        polygon.push(voxels);
    }
    if (!near) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            polygon = cut(polygon, axis, -1.0, -1.0);
            polygon = cut(polygon, axis, 1.0, double(grid.resolution) + 1.0);
        }
    }
    for (int k = 2; k < polygon.count; ++k)
        pieces.piece[std::size_t(pieces.count++)] = snapped(polygon.corner[0], polygon.corner[std::size_t(k - 1)], polygon.corner[std::size_t(k)]);
    return pieces;
}

}  // namespace lrsm
