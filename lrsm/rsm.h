#pragma once

#include "core/base/arrays.h"
#include "core/base/formats.h"
#include "core/base/image.h"
#include "core/raster/rasterize.h"
#include "core/scene/requirements.h"
#include "lrsm/light_projection.h"

namespace lrsm {

/// One texel of a reflective shadow map, in the values its storage holds (storage = gpu: each component is representable as half; depth is float32).
struct RsmTexel {
    Vec3 radiance{0.0f};    ///< rho L_d <n.l> / pi, W/(m^2 sr), times Rsm::preExposure
    float coverage = 0.0f;  ///< 1 where a surface was drawn
    Vec3 normal{0.0f};      ///< unit before rounding, towards the light
    float nDotL = 0.0f;     ///< of the geometric situation at the texel, in [0, 1]
};

struct Rsm {
    LightProjection projection;
    Image<RsmTexel> texels;
    Image<float> depthLinear;  ///< [0, 1]; 1 where empty
    float preExposure = 1.0f;  ///< what `radiance` is multiplied by (preExposureOf)
    RasterCounts raster;
    ConversionCounts conversions;

    /// In the GPU's formats: two textures of 16 bits x 4, and a 32-bit depth.
    static constexpr std::size_t kGpuTexelBytes = 16, kGpuDepthBytes = 4;
    static std::size_t predictGpuBytes(int resolution) { return std::size_t(resolution) * std::size_t(resolution) * (kGpuTexelBytes + kGpuDepthBytes); }
    static std::size_t predictBytes(int resolution) { return std::size_t(resolution) * std::size_t(resolution) * (sizeof(RsmTexel) + sizeof(float)); }
};

template <class Visit>
void forEachArray(const Rsm& rsm, Visit&& visit)
{
    visit(rsm.texels.texels, ArrayTraits{rsm.texels.texels.size() * Rsm::kGpuTexelBytes});
    visit(rsm.depthLinear.texels, ArrayTraits{rsm.depthLinear.texels.size() * Rsm::kGpuDepthBytes});
}

/// Triangles, and what the conversion to half saturated or found to be NaN.
Counters countersOf(const Rsm& rsm);

/// Eq. 2's integrand at a texel: rho L_d <n.l> / pi, W/(m^2 sr), for the irradiance L_d of a delta light on a plane that faces it.
/// Relative error <= kReflectedRadianceMaxError.
inline constexpr float kReflectedRadianceMaxError = 2.5e-7f;
inline Vec3 reflectedRadiance(const Vec3& albedo, const Vec3& irradiance, float nDotL)
{
    return albedo * irradiance * (nDotL / kPi);
}

/// What a whole map keeps, rasterized and lit in float: radiance over that straight below the light; relative depth, and <n.l>.
inline constexpr float kRsmRadianceMaxError = 1e-5f, kRsmDepthMaxError = 3e-6f;

/// How the light's map of this scene lies.
LightProjection projectionOf(const Scene& scene, const Light& light, const RsmSettings& settings);

/// Renders the scene from one light (Sec. 3.2, [DS05]): all of it, or its reach (settings.extent) with what stands before it. Texels whose surface lies
/// beyond the reach stay empty.
Rsm renderRsm(const Scene& scene, const Light& light, const Requirements& needs, const RsmSettings& settings,
              TextureFilter textureFilter = TextureFilter::trilinear);

}  // namespace lrsm
