#pragma once

#include "conetrace/frame/gbuffer.h"

namespace lrsm {

/// Averages the 16 cone rotations of a 4x4 pattern: a centred 5x5 box of width 4 (outer rows and columns count half, so each rotation weighs exactly
/// 1/16), over the pixels that lie on the same surface: normals within about 25 degrees, and each pixel within a tenth of their
/// distance from the other's tangent plane. A constant field stays constant. `rows`: of the picture, from the top; what is below stays as it is.
Image<Vec3> filterIrradiance(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int rows);
inline Image<Vec3> filterIrradiance(const Image<Vec3>& irradiance, const GBuffer& gbuffer)
{
    return filterIrradiance(irradiance, gbuffer, gbuffer.height);
}

}  // namespace lrsm
