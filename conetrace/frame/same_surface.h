#pragma once

#include "conetrace/frame/gbuffer.h"

/// Which pixels may lend each other light.
namespace lrsm {

inline constexpr float kSameNormalCosine = 0.9f;  ///< about 25 degrees
inline constexpr float kSamePlaneSlope = 0.1f;    ///< off the other's tangent plane, over the distance between them

/// Two covered pixels on one surface: normals alike, and each point near the other's tangent plane.
inline bool sameSurface(const GBuffer& g, std::size_t a, std::size_t b)
{
    if (!g.covered(b) || glm::dot(g.normal.texels[a], g.normal.texels[b]) < kSameNormalCosine) return false;
    const Vec3 between = g.position.texels[b] - g.position.texels[a];
    const float limit = kSamePlaneSlope * kSamePlaneSlope * glm::dot(between, between);
    const float fromA = glm::dot(between, g.geometricNormal.texels[a]), fromB = glm::dot(between, g.geometricNormal.texels[b]);
    return fromA * fromA <= limit && fromB * fromB <= limit;
}

}  // namespace lrsm
