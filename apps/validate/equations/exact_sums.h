#pragma once

#include <glm/glm.hpp>
#include <span>

/// The equations that the paper states only to replace them, as direct sums over RSM texels in double: what Eq. 5-15 approximate.
namespace lrsm {

/// What one RSM texel stands for. All directions are unit and point away from the surface.
struct TexelSample {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0, 1.0, 0.0};
    glm::dvec3 toLight{0.0, 1.0, 0.0};
    glm::dvec3 radiance{0.0};  ///< rho L_d <n.l> / pi
    double solidAngle = 1.0;   ///< w(omega) d omega; any common factor cancels
};

/// Solid angle of the texel at (x, y) in [-1, 1]^2 of a square perspective map of `resolution`^2 texels with tangent `halfWidth` at its edge:
/// area over (1 + u^2 + v^2)^(3/2).
double texelSolidAngle(double x, double y, double halfWidth, int resolution);

/// V(x, x_c, r_c) of Eq. 3 and 7: H(r_c - |x - x_c|), H(0) = 1.
bool insideSample(const TexelSample& texel, const glm::dvec3& centre, double radius);

/// Eq. 4 with w = 1 and V(x, v) = 1: <n.v> / <n.l>, 0 where n faces away from v. A texel outside the sample counts as shadowed surface that faces
/// the light (n = l, the second assumption of Sec. 4.1): <l.v>. <n.l> <= 0 gives 0: such a texel is not lit.
double weightEq4(const TexelSample& texel, const glm::dvec3& toReceiver, bool inside);

/// Eq. 3: the weighted mean of radiance over the texels; 0 if no weight is left.
glm::dvec3 radianceEq3(std::span<const TexelSample> texels, const glm::dvec3& centre, double radius, const glm::dvec3& toReceiver);

/// Eq. 7: the fraction of the solid angle whose texels lie in the sample.
double visibilityEq7(std::span<const TexelSample> texels, const glm::dvec3& centre, double radius);

/// What the sums keep against closed forms: rounding of 4096 texels and of three; the midpoint rule over 256^2 texels; a disc counted by 256^2 centres.
inline constexpr double kDirectSumMaxError = 1e-13, kThreeTexelSumMaxError = 7e-15, kTexelSumMaxError = 1e-5, kCountedDiscMaxError = 1e-3;

/// How far Eq. 12 is from Eq. 7, whatever the arithmetic: depths that are uniform (one sloped plane), and two depths (an edge in the footprint; two equal
/// halves, any window). The latter is why there are layers.
inline constexpr double kGaussianForSlopeMaxError = 0.115;
inline constexpr double kGaussianForEdgeMaxError = 0.683;

}  // namespace lrsm
