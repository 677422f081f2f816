#include "conetrace/frame/light_grid.h"

#include <algorithm>

namespace lrsm {

namespace {

constexpr double kMostCells = 4096.0;  // along an edge

void add(Polygon& polygon, const DVec2& corner)
{
    polygon.corners[std::size_t(polygon.count++)] = corner;
}

}  // namespace

Polygon polygonOf(const LightView& view, const std::array<DVec3, 3>& p, double nearest)
{
    Polygon polygon;
    for (std::size_t i = 0; i < 3; ++i) {
        const DVec3 &a = p[i], &b = p[(i + 1) % 3];
        const bool aInside = view.directional() || a.z >= nearest, bInside = view.directional() || b.z >= nearest;
        if (aInside) add(polygon, view.onPlane(a));
        if (aInside == bInside) continue;
        DVec3 cut = a + (b - a) * ((nearest - a.z) / (b.z - a.z));
        cut.z = nearest;
        add(polygon, view.onPlane(cut));
    }
    return polygon;
}

LightGrid::LightGrid(const DVec2& min, const DVec2& max, double cells)
{
    const DVec2 extent = max - min;
    // A line of surfaces, or a point, still has an area, and one that a double can hold.
    constexpr double kLeastExtent = 0x1p-500;
    const double longest = std::max({extent.x, extent.y, kLeastExtent});
    const DVec2 size = glm::max(extent, DVec2(longest / kMostCells));
    min_ = min;
    scale_ = std::min(std::sqrt(cells / (size.x * size.y)), kMostCells / longest);
    columns_ = std::max(1, static_cast<int>(std::ceil(size.x * scale_)));
    rows_ = std::max(1, static_cast<int>(std::ceil(size.y * scale_)));
}

LightGrid::Range LightGrid::rangeOf(double low, double high, double origin, int size) const
{
    const double first = (low - origin) * scale_ - kSlack, last = (high - origin) * scale_ + kSlack;
    if (!(last >= 0.0 && first <= double(size))) return {};
    return {clampTo(first, size), clampTo(last, size)};
}

LightGrid::Range LightGrid::columnsOf(const Polygon& polygon, int row) const
{
    const double low = min_.y + (double(row) - kSlack) / scale_, high = min_.y + (double(row + 1) + kSlack) / scale_;
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (int i = 0; i < polygon.count; ++i) {
        DVec2 a = polygon.corners[std::size_t(i)], b = polygon.corners[std::size_t(i + 1 == polygon.count ? 0 : i + 1)];
        if (a.y > b.y) std::swap(a, b);
        if (b.y < low || a.y > high) continue;
        const auto at = [&](double y) { return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)); };
        const double from = a.y < low ? at(low) : a.x, to = b.y > high ? at(high) : b.x;
        left = std::min({left, from, to});
        right = std::max({right, from, to});
    }
    return left <= right ? rangeOf(left, right, min_.x, columns_) : Range{};
}

}  // namespace lrsm
