#pragma once

#include "core/raster/rasterize.h"

#include <array>
#include <cmath>
#include <vector>

/// The rules of the D3D11.3 functional specification evaluated the slow way, for one triangle and a small picture: long double clipping,
/// integer winding numbers, no tiles, no increments. Shares no code with the product.
namespace oracle {

struct Point {
    long double x, y, z, w;
};
struct Snapped {
    long long x, y;       // 1/256 pixel
    long double z, invW;  // z/w and 1/w
};

inline long long nearestEven(long double v)
{
    const long double below = std::floor(v), rest = v - below;
    const auto n = static_cast<long long>(below);
    if (rest != 0.5L) return rest < 0.5L ? n : n + 1;
    return n % 2 == 0 ? n : n + 1;
}

inline Snapped project(const Point& p, int width, int height)
{
    return {nearestEven((p.x / p.w + 1) * width * 128), nearestEven((1 - p.y / p.w) * height * 128), p.z / p.w, 1 / p.w};
}

/// The part of the triangle with distance >= 0.
template <class Distance>
std::vector<Point> clip(const std::vector<Point>& in, Distance distance)
{
    std::vector<Point> out;
    for (std::size_t i = 0; i < in.size(); ++i) {
        const Point &a = in[i], &b = in[(i + 1) % in.size()];
        const long double da = distance(a), db = distance(b);
        if (da >= 0) out.push_back(a);
        if ((da >= 0) != (db >= 0)) {
            const long double s = da / (da - db);
            out.push_back({a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z), a.w + s * (b.w - a.w)});
        }
    }
    return out;
}

/// The near plane, then a guard band 16384 pixels from the picture's centre, as the header promises ("far outside the picture").
inline std::vector<Snapped> snappedPolygon(const std::array<lrsm::Vec4, 3>& triangle, int width, int height)
{
    std::vector<Point> polygon;
    for (const lrsm::Vec4& v : triangle) polygon.push_back({v.x, v.y, v.z, v.w});
    const long double gx = 32768.0L / width, gy = 32768.0L / height;
    polygon = clip(polygon, [](const Point& p) { return p.z; });
    polygon = clip(polygon, [](const Point& p) { return p.w - 1e-20L; });
    polygon = clip(polygon, [&](const Point& p) { return gx * p.w + p.x; });
    polygon = clip(polygon, [&](const Point& p) { return gx * p.w - p.x; });
    polygon = clip(polygon, [&](const Point& p) { return gy * p.w + p.y; });
    polygon = clip(polygon, [&](const Point& p) { return gy * p.w - p.y; });
    std::vector<Snapped> result;
    for (const Point& p : polygon) result.push_back(project(p, width, height));
    return result;
}

/// Winding number about the pixel's centre, moved right by an infinitesimal and down by its square: which is the top-left rule.
inline int winding(const std::vector<Snapped>& polygon, int pixelX, int pixelY)
{
    const long long px = 256LL * pixelX + 128, py = 256LL * pixelY + 128;
    int number = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Snapped &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const bool aAbove = a.y <= py, bAbove = b.y <= py;
        if (aAbove == bAbove) continue;
        // Does the edge pass right of the point? x(py) > px, multiplied by the edge's height.
        const __int128 side = __int128(a.x - px) * (b.y - a.y) + __int128(py - a.y) * (b.x - a.x);
        if (bAbove ? side < 0 : side > 0) number += bAbove ? -1 : 1;
    }
    return number;
}

inline long long twiceArea(const std::vector<Snapped>& polygon)
{
    long long sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Snapped &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        sum += a.x * b.y - b.x * a.y;
    }
    return sum;
}

struct Exact {
    long double b1, b2, depth;
};
/// Depth (linear on the screen) and perspective-correct barycentrics of an unclipped triangle at a pixel's centre.
inline Exact interpolate(const std::vector<Snapped>& t, int pixelX, int pixelY)
{
    const long double px = 256.0L * pixelX + 128, py = 256.0L * pixelY + 128;
    long double e[3], area = 0, sum = 0, depth = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Snapped &a = t[(i + 1) % 3], &b = t[(i + 2) % 3];
        e[i] = (b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x);
        area += e[i];
        sum += e[i] * t[i].invW;
        depth += e[i] * t[i].z;
    }
    return {e[1] * t[1].invW / sum, e[2] * t[2].invW / sum, depth / area};
}

}  // namespace oracle
