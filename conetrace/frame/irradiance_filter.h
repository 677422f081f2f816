#pragma once

#include "conetrace/frame/gbuffer.h"

namespace lrsm {

/// Averages the 16 cone rotations of a 4x4 pattern: a centred 5x5 box of width 4 (outer rows and columns count half, so each rotation weighs exactly
/// 1/16), over the pixels that lie on the same surface: normals within about 25 degrees, and each pixel within a tenth of their
/// distance from the other's tangent plane. A constant field stays constant. `rows`: of the picture, from the top; what is below stays as it is.
Image<Vec3> filterIrradiance(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int rows);
/// The same of the mean radiance over specular lobes that are sampled (lobe.h): means weighted by `lobeWeight` besides. Narrow lobes stay as they are.
Image<Vec3> filterSpecular(const Image<Vec3>& specular, const Image<float>& lobeWeight, const GBuffer& gbuffer, int rows);
/// Each of one pixel.
Vec3 filterSpecularPixel(const Image<Vec3>& specular, const Image<float>& lobeWeight, const GBuffer& gbuffer, int rows, int x, int y);
Vec3 filterPixel(const Image<Vec3>& irradiance, const GBuffer& gbuffer, int rows, int x, int y);
inline Image<Vec3> filterIrradiance(const Image<Vec3>& irradiance, const GBuffer& gbuffer)
{
    return filterIrradiance(irradiance, gbuffer, gbuffer.height);
}

}  // namespace lrsm
