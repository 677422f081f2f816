#pragma once

#include "conetrace/frame/gbuffer.h"
#include "core/base/parallel.h"

/// What the filters of irradiance share: the walk over pixels, and which of them may lend each other light.
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

inline bool inPicture(const GBuffer& g, int x, int y)
{
    return x >= 0 && y >= 0 && x < g.width && y < g.height;
}

inline constexpr std::size_t kFilterRowsPerTask = 8;

/// pixel(x, y) for all covered pixels, in parallel.
template <class Pixel>
void forCovered(const GBuffer& g, const Pixel& pixel)
{
    parallelFor(std::size_t(g.height), kFilterRowsPerTask, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < g.width; ++x)
                if (g.covered(g.position.index(x, y))) pixel(x, y);
    });
}

}  // namespace lrsm
