#pragma once

#include "lrsm/footprint.h"

#include <algorithm>
#include <cmath>

/// The equations that are a line, once more in long double: nothing of the kernels is in them.
namespace lrsm::oracle {

inline constexpr long double kPi = 3.14159265358979323846264338327950288L;

/// Eq. 2, of one RSM texel: rho L_d <n.l> / pi.
inline long double reflectedRadiance(float rho, float lightRadiance, float nDotL)
{
    return static_cast<long double>(rho) * static_cast<long double>(lightRadiance) * static_cast<long double>(nDotL) / kPi;
}

/// Eq. 8: <nBar . v>, at least 0, of the premultiplied mean.
inline long double normalTerm(const FilteredTexel& texel, const Vec3& v)
{
    const long double n =
        (static_cast<long double>(texel.normal.x) * v.x + static_cast<long double>(texel.normal.y) * v.y + static_cast<long double>(texel.normal.z) * v.z) /
        texel.normalAlpha;
    return std::max(n, 0.0L);
}

/// Eq. 10 and 11, of the premultiplied sums; the variance as it is, without a floor.
inline long double depthMean(const FilteredTexel& texel)
{
    return static_cast<long double>(texel.depth) / texel.depthAlpha;
}
inline long double depthVariance(const FilteredTexel& texel)
{
    const long double mean = depthMean(texel);
    return static_cast<long double>(texel.depthSquared) / texel.depthAlpha - mean * mean;
}
/// What UNORM16 moments resolve (docs/equations.md), written here a second time.
inline constexpr long double kVarianceFloor = 2.5e-5L;

/// Fig. 7's cone i of six: the axis upwards (+z), then five at 60 degrees; weights 1/4 and 3/20; tan of 30 degrees.
struct Cone {
    double axis[3], weight, tanHalf;
};
inline Cone coneOfSix(int i)
{
    const double pi = static_cast<double>(kPi), azimuth = 2.0 * pi * (double(i) - 1.0) / 5.0, sine = i ? std::sin(pi / 3) : 0.0;
    return {{sine * std::cos(azimuth), sine * std::sin(azimuth), i ? 0.5 : 1.0}, i ? 3.0 / 20.0 : 1.0 / 4.0, std::tan(pi / 6)};
}

/// `aperture=roughness`: tan(2 atan(roughness^2)), at most tan 60 degrees.
inline double specularTanHalf(float roughness)
{
    const double alpha = double(roughness) * double(roughness);
    return std::min(std::tan(static_cast<double>(kPi) / 3), alpha < 1.0 ? std::tan(2.0 * std::atan(alpha)) : 1e9);
}

}  // namespace lrsm::oracle
