// Lambert azimuthal equal-area projection: Snyder, "Map Projections: A Working Manual", USGS 1395, 1987, section 24.
#include "reference/light_map.h"

#include "core/base/elementary.h"

namespace lrsm {
namespace {

/// A point on the rectangle's border must not fall out of the square by rounding.
constexpr double kMargin = 1.0 + 0x1p-20;

double squared(double x)
{
    return x * x;
}

}  // namespace

LightMap::LightMap(const Light& light, const Aabb& sceneBounds) : type_(light.type), origin_(light.position)
{
    const Mat3 basis = basisFromNormal(light.direction);
    right_ = basis[0];
    up_ = basis[1];
    axis_ = light.direction;
    if (type_ == LightType::spot) versineOuter_ = 2.0 * squared(sinCos(0.5 * double(light.outerConeAngle)).sin);
    if (type_ != LightType::directional || sceneBounds.empty()) return;

    // The rectangle holds the box's projection: half its extent along an axis is sum of |axis_i| extent_i / 2.
    const DVec3 half = 0.5 * DVec3(sceneBounds.extent()), centre = 0.5 * (DVec3(sceneBounds.min) + DVec3(sceneBounds.max));
    const auto halfAlong = [&](const DVec3& axis) { return glm::dot(glm::abs(axis), half); };
    const double depth = halfAlong(axis_), least = 1e-6 * glm::length(half) + 1e-30;
    halfWidth_ = kMargin * std::max(halfAlong(right_), least);
    halfHeight_ = kMargin * std::max(halfAlong(up_), least);
    origin_ = centre - axis_ * (kMargin * (depth + least));
}

std::optional<Ray> LightMap::ray(UnitPoint at, float offset) const
{
    const double a = 2.0 * double(at.u) - 1.0, b = 2.0 * double(at.v) - 1.0;
    if (type_ == LightType::directional)
        return Ray{Vec3(origin_ + right_ * (a * halfWidth_) + up_ * (b * halfHeight_)), Vec3(axis_), 0.0f, kInfinity, RayKind::eye};

    DVec3 direction = glm::normalize(axis_ + right_ * a + up_ * b);  // a cube face's
    if (type_ == LightType::spot) {
        const double radius2 = a * a + b * b;
        if (!(radius2 < 1.0)) return std::nullopt;
        // sin / sqrt(radius2) = sqrt(versine (2 - versine) / radius2)
        const double versine = versineOuter_ * radius2, scale = std::sqrt(versineOuter_ * (2.0 - versine));
        direction = glm::normalize(axis_ * (1.0 - versine) + (right_ * a + up_ * b) * scale);
    }
    return Ray{Vec3(origin_), Vec3(direction), offset, kInfinity, RayKind::eye};
}

std::optional<LightCoordinates> LightMap::coordinates(const Vec3& p) const
{
    const DVec3 from = DVec3(p) - origin_;
    double a = glm::dot(from, right_), b = glm::dot(from, up_), perArea = 0.0;
    if (type_ == LightType::directional) {
        a /= halfWidth_;
        b /= halfHeight_;
        perArea = 0.25 / (halfWidth_ * halfHeight_);
    } else if (type_ == LightType::spot) {
        const double distance2 = glm::dot(from, from), distance = std::sqrt(distance2);
        const DVec3 off = from / distance - axis_;
        const double versine = 0.5 * glm::dot(off, off);
        const double scale = 1.0 / (distance * std::sqrt(versineOuter_ * (2.0 - versine)));
        a *= scale;
        b *= scale;
        perArea = 1.0 / (8.0 * versineOuter_ * distance2);
    } else {
        const double along = glm::dot(from, axis_);
        if (!(along > 0.0)) return std::nullopt;
        a /= along;
        b /= along;
        const double slant2 = 1.0 + a * a + b * b;
        perArea = slant2 * std::sqrt(slant2) / (4.0 * glm::dot(from, from));
    }
    const UnitPoint at{float(0.5 * (a + 1.0)), float(0.5 * (b + 1.0))};
    const auto inside = [](float x) { return x >= 0.0f && x < 1.0f; };
    if (!inside(at.u) || !inside(at.v) || !std::isfinite(perArea)) return std::nullopt;
    return LightCoordinates{at, perArea};
}

}  // namespace lrsm
