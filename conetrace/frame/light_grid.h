#pragma once

#include "core/scene/scene.h"

#include <array>
#include <limits>

/// The plane that a light sees the world on, in double, and a grid over the part of it that matters (internal to shadow rays).
namespace lrsm {

using DVec2 = glm::dvec2;
using DVec3 = glm::dvec3;

/// Directional: metres across the light's axis. Spot, cube face: metres across over metres along, from the light.
class LightView {
  public:
    explicit LightView(const Light& light)
        : directional_(light.type == LightType::directional),
          position_(light.position),
          forward_(light.direction),
          right_(glm::cross(DVec3(light.direction), DVec3(light.up))),
          up_(light.up)
    {
    }

    bool directional() const { return directional_; }
    const DVec3& position() const { return position_; }  ///< not of a directional light
    const DVec3& forward() const { return forward_; }

    /// Across and up, in metres, and metres along the axis.
    DVec3 toLightSpace(const DVec3& pWorld) const
    {
        const DVec3 d = directional_ ? pWorld : pWorld - position_;
        return {glm::dot(d, right_), glm::dot(d, up_), glm::dot(d, forward_)};
    }
    /// Of a point in front of the light.
    DVec2 onPlane(const DVec3& inLightSpace) const { return directional_ ? DVec2(inLightSpace) : DVec2(inLightSpace) / inLightSpace.z; }

  private:
    bool directional_;
    DVec3 position_, forward_, right_, up_;
};

/// A convex polygon: a triangle, cut by one plane.
struct Polygon {
    std::array<DVec2, 4> corners;
    int count = 0;
    DVec2 min() const
    {
        return bound([](double a, double b) { return std::min(a, b); });
    }
    DVec2 max() const
    {
        return bound([](double a, double b) { return std::max(a, b); });
    }

  private:
    template <class Pick>
    DVec2 bound(Pick pick) const
    {
        DVec2 result = corners[0];
        for (int i = 1; i < count; ++i) result = {pick(result.x, corners[std::size_t(i)].x), pick(result.y, corners[std::size_t(i)].y)};
        return result;
    }
};

/// What the light sees of a triangle farther away than `nearest` along its axis (of directional lights: all of it), on its plane. Empty: nothing.
Polygon polygonOf(const LightView& view, const std::array<DVec3, 3>& inLightSpace, double nearest);

/// Square cells over a rectangle of that plane.
class LightGrid {
  public:
    LightGrid() = default;
    /// About `cells` of them over [min, max].
    LightGrid(const DVec2& min, const DVec2& max, double cells);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    std::size_t cells() const { return std::size_t(columns_) * std::size_t(rows_); }
    std::size_t cellOf(const DVec2& onPlane) const
    {
        const DVec2 at = (onPlane - min_) * scale_;
        return std::size_t(clampTo(at.y, rows_)) * std::size_t(columns_) + std::size_t(clampTo(at.x, columns_));
    }

    /// Cells that a range may touch, inclusive; empty where it is outside.
    struct Range {
        int first = 0, last = -1;
        bool empty() const { return last < first; }
    };
    Range rowsOf(const Polygon& polygon) const { return rangeOf(polygon.min().y, polygon.max().y, min_.y, rows_); }
    Range columnsOf(const Polygon& polygon) const { return rangeOf(polygon.min().x, polygon.max().x, min_.x, columns_); }
    /// In one row of cells: what of the polygon is in its strip.
    Range columnsOf(const Polygon& polygon, int row) const;

  private:
    static constexpr double kSlack = 1e-3;  ///< cells; far above the rounding of any projection
    static int clampTo(double at, int size) { return at > 0.0 ? static_cast<int>(std::min(at, double(size - 1))) : 0; }
    Range rangeOf(double low, double high, double origin, int size) const;

    DVec2 min_{0.0};
    double scale_ = 0.0;  ///< cells over its unit
    int columns_ = 0, rows_ = 0;
};

}  // namespace lrsm
