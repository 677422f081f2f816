#pragma once

#include "core/base/math.h"
#include "core/settings/settings.h"

#include <vector>

/// A cache's hemisphere as a square of texels. The tangent frame is basisFromNormal's, z the cache's axis; u, v in [0, 1], u to the right.
///
/// `equal_area`: Shirley and Chiu's concentric map of the square to the disc (JGT 2(3), 1997), the disc to the hemisphere by z = 1 - r^2. All texels have one
/// solid angle, 2 pi / N^2, so a mip is the plain mean of four.
/// `octahedral`: the upper half of an octahedron, turned by 45 degrees: + - * / alone, but texels differ 4.2-fold and mips weigh them.
namespace lrsm {

/// Unit direction of a point of the square; in double, for tables.
glm::dvec3 hemisphereFromSquare(double u, double v, CacheMapping mapping);

/// arctan on [-1, 1], Abramowitz and Stegun 4.4.49: its own error of 2e-8, and float's rounding.
inline constexpr float kOctantArcTangentMaxError = 1.5e-7f;
inline float octantArcTangent(float t)
{
    const float s = t * t;
    float series = 0.0028662257f;
    for (const float coefficient : {-0.0161657367f, 0.0429096138f, -0.0752896400f, 0.1065626393f, -0.1420889944f, 0.1999355085f, -0.3333314528f, 1.0f})
        series = series * s + coefficient;
    return t * series;
}

/// The inverse: (u, v) of a unit direction, within kSquareMaxError. What is below the horizon is moved up to it.
inline constexpr float kSquareMaxError = 3e-7f;
Vec2 squareFromHemisphere(const Vec3& direction, CacheMapping mapping);

inline constexpr int kDiffuseNodes = 9;   ///< edge of a cache's table of irradiance: an interval a texel of 8^2, with nodes on axis and horizon
inline constexpr int kSubdirections = 4;  ///< along an edge of a texel, for means over it

/// What all caches of a frame share, made once in double.
struct CacheTables {
    CacheMapping mapping = CacheMapping::equalArea;
    int resolution = 0;  ///< N, texels along an edge
    /// Of the texels' cones, [rotation * N^2 + row * N + column]: through their middles, or with rotation=strata through the stratumPlace of each rotation.
    std::vector<Vec3> directions;
    std::vector<std::vector<float>> solidAngle;  ///< of the texels of each level, sr; those of a level sum to 2 pi
    /// Of each of the kDiffuseNodes^2 normals m, (column, row) / (kDiffuseNodes - 1) in the square, the share of each texel in the irradiance, [m * N^2 +
    /// texel]: E(m) = pi sum share L. `renormalise`: <m.w> dw over its sum over the cache's hemisphere; `black`: over pi. <m.w>+ is the mean over
    /// kSubdirections^2 directions of the texel.
    std::vector<float> cosineShare;

    std::size_t texels() const { return std::size_t(resolution) * std::size_t(resolution); }
    int levels() const { return static_cast<int>(solidAngle.size()); }
};
CacheTables makeCacheTables(const CacheSettings& settings, Rotation rotation);

/// Tangent of the traced half-angle of a texel's cone: `scale` times h, cos h = 1 - 1/N^2, which is a circular cone of the texels' mean solid angle.
float texelTanHalf(int resolution, float scale);

}  // namespace lrsm
