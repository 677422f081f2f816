#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

/// GLM's types under our names, and the few geometric helpers that every module needs.
/// Conventions: right-handed, +Y up, column vectors (clip = projection * view * p), metres, radians.
namespace lrsm {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using IVec2 = glm::ivec2;
using IVec3 = glm::ivec3;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Axis-aligned box, closed. A default box is empty (min > max) and grows by `include`.
struct Aabb {
    Vec3 min{kInfinity};
    Vec3 max{-kInfinity};

    void include(const Vec3& p)
    {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    void include(const Aabb& box)
    {
        min = glm::min(min, box.min);
        max = glm::max(max, box.max);
    }
    bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
    Vec3 centre() const { return 0.5f * (min + max); }
    Vec3 extent() const { return max - min; }
    float longestSide() const
    {
        const Vec3 e = extent();
        return std::max({e.x, e.y, e.z});
    }
    /// i in [0, 8): bit k set: the far side along axis k.
    Vec3 corner(unsigned i) const { return {i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z}; }
    bool contains(const Vec3& p) const { return glm::all(glm::greaterThanEqual(p, min)) && glm::all(glm::lessThanEqual(p, max)); }
    bool operator==(const Aabb&) const = default;
};

/// Orthonormal basis about `normal` (unit): columns are tangent, bitangent, normal.
/// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017. The rule is part of the
/// golden definition: the azimuth of every cone hangs on it.
inline Mat3 basisFromNormal(const Vec3& normal)
{
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z);
    const float b = normal.x * normal.y * a;
    return Mat3(Vec3(1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x), Vec3(b, sign + normal.y * normal.y * a, -normal.y), normal);
}

inline bool isFinite(const Vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace lrsm
