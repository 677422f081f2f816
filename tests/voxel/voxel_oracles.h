#pragma once

#include "core/base/math.h"
#include "voxel/bit_grid.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

/// Slow, obvious twins of what the voxelizer does: one box and one triangle at a time, in integers of 128 bits.
namespace oracle {

using lrsm::Vec3;
__extension__ using Int = __int128;
using Point = std::array<Int, 3>;

/// Nearest 1/4096 voxel, halves up; written with long double and independent of the product's code.
inline Point snapped(const Vec3& pWorld, const lrsm::VoxelGrid& grid)
{
    Point p;
    for (int axis = 0; axis < 3; ++axis) {
        const long double voxels = ((long double)(pWorld[axis]) - (long double)(grid.origin[axis])) / (long double)(grid.voxelSize);
        p[std::size_t(axis)] = Int(std::floor(voxels * 4096.0L + 0.5L));
    }
    return p;
}

inline Point minus(const Point& a, const Point& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Int dot(const Point& a, const Point& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point& a, const Point& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Separating axis theorem (Akenine-Moller 2001, all 13 axes, both sides), closed box against closed triangle.
inline bool boxOverlap(const std::array<Point, 3>& t, int x, int y, int z)
{
    const Point edges[3] = {minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])};
    const Point units[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<Point> axes = {units[0], units[1], units[2], cross(edges[0], edges[1])};
    for (const Point& e : edges)
        for (const Point& u : units) axes.push_back(cross(e, u));
    for (const Point& axis : axes) {
        Int triangleLow = dot(axis, t[0]), triangleHigh = triangleLow;
        for (const Point& v : t) {
            triangleLow = std::min(triangleLow, dot(axis, v));
            triangleHigh = std::max(triangleHigh, dot(axis, v));
        }
        Int boxLow = 0, boxHigh = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const Point p = {Int(x + (corner & 1)) * 4096, Int(y + ((corner >> 1) & 1)) * 4096, Int(z + (corner >> 2)) * 4096};
            const Int d = dot(axis, p);
            boxLow = corner == 0 ? d : std::min(boxLow, d);
            boxHigh = corner == 0 ? d : std::max(boxHigh, d);
        }
        if (triangleHigh < boxLow || boxHigh < triangleLow) return false;
    }
    return true;
}

/// Does one of the box's three axis-parallel segments through its centre meet the closed triangle? 6-separating by construction
/// (Laine, "A Topological Approach to Voxelization", 2013): the least that a thin voxelization has to hold. Non-degenerate triangles.
inline bool crosshairHit(const std::array<Point, 3>& t, int x, int y, int z)
{
    // Everything times 2, so that the centre is an integer.
    const Point c = {Int(2 * x + 1) * 4096, Int(2 * y + 1) * 4096, Int(2 * z + 1) * 4096};
    std::array<Point, 3> v;
    for (std::size_t k = 0; k < 3; ++k) v[k] = {2 * t[k][0] - c[0], 2 * t[k][1] - c[1], 2 * t[k][2] - c[2]};
    const Point n = cross(minus(v[1], v[0]), minus(v[2], v[0]));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (n[axis] == 0) continue;
        const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
        bool positive = false, negative = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point& p = v[k];
            const Point& q = v[(k + 1) % 3];
            const Int side = p[a] * q[b] - p[b] * q[a];
            positive = positive || side > 0;
            negative = negative || side < 0;
        }
        if (positive && negative) continue;
        // Plane: n . (s e_axis) = n . v0, |s| <= 4096 (half a voxel, doubled).
        const Int reach = 4096 * (n[axis] < 0 ? -n[axis] : n[axis]);
        const Int d = dot(n, v[0]);
        if (d <= reach && -d <= reach) return true;
    }
    return false;
}

inline std::vector<Vec3> sphereMesh(Vec3 centre, float radius, int rings, int sectors)
{
    const auto at = [&](int i, int j) {
        const double theta = M_PI * i / rings, phi = 2 * M_PI * (j % sectors) / sectors;
        if (i == 0) return centre + Vec3(0, radius, 0);
        if (i == rings) return centre - Vec3(0, radius, 0);
        return centre + radius * Vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
    };
    std::vector<Vec3> corners;
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < sectors; ++j) {
            for (const Vec3& p : {at(i, j), at(i + 1, j), at(i + 1, j + 1)}) corners.push_back(p);
            for (const Vec3& p : {at(i, j), at(i + 1, j + 1), at(i, j + 1)}) corners.push_back(p);
        }
    }
    return corners;
}

/// Parallelepiped centre +- a +- b +- c.
inline std::vector<Vec3> boxMesh(Vec3 centre, Vec3 a, Vec3 b, Vec3 c)
{
    std::vector<Vec3> corners;
    const std::array<Vec3, 3> sides[3] = {{a, b, c}, {b, c, a}, {c, a, b}};
    for (const auto& [n, s, t] : sides) {
        for (const float sign : {-1.0f, 1.0f}) {
            const Vec3 m = centre + sign * n;
            for (const Vec3& p : {m - s - t, m + s - t, m + s + t, m - s - t, m + s + t, m - s + t}) corners.push_back(p);
        }
    }
    return corners;
}

}  // namespace oracle
