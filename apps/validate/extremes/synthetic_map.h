#pragma once

#include "apps/validate/extremes/catalogue.h"
#include "lrsm/sample.h"

namespace lrsm::extremes {

struct MapTexel {
    float depth = 0.5f;
    Vec3 radiance{1.0f};
    Vec3 normal{0.0f, 0.0f, 1.0f};
    float nDotL = 0.9f;
    float coverage = 1.0f;
};

/// A reflective shadow map made by hand: an orthographic light at z = 0 that looks along -z, 2 m wide, depths over `range` metres from `nearMetres` on.
template <class Texel>
Rsm syntheticMap(int resolution, Texel&& texel, float range = 1.0f, float nearMetres = 0.0f)
{
    Rsm rsm;
    rsm.projection.depthNear = nearMetres;
    rsm.projection.depthFar = nearMetres + range;
    rsm.projection.resolution = resolution;
    rsm.texels = Image<RsmTexel>(resolution, resolution);
    rsm.depthLinear = Image<float>(resolution, resolution, 1.0f);
    for (int y = 0; y < resolution; ++y)
        for (int x = 0; x < resolution; ++x) {
            const MapTexel t = texel(x, y);
            if (!(t.coverage > 0.0f)) continue;
            rsm.texels.at(x, y) = {t.radiance, t.coverage, t.normal, t.nDotL};
            rsm.depthLinear.at(x, y) = t.depth;
        }
    return rsm;
}

inline LayerSettings layerSettings(Mode mode, int depthLayers = 2, int normalLayers = 2, float overlap = 0.0f)
{
    LayerSettings settings;
    settings.depthLayers = depthLayers;
    settings.normalLayers = normalLayers;
    settings.overlap = overlap;
    settings.storage = mode == Mode::float32 ? Storage::float32 : Storage::gpu;
    settings.halfRounding = mode == Mode::gpuNearestEven ? HalfRounding::nearestEven : HalfRounding::d3d;
    return settings;
}

/// Algorithm 1 as printed, all layers that hold z_c.
inline ConeSettings paperCones()
{
    ConeSettings cones;
    cones.estimator = Estimator::paper;
    cones.layerSelection = LayerSelection::centre;
    cones.backface = Backface::cosine;
    cones.gaussian = GaussianMethod::exact;
    return cones;
}

/// What a sample at (u, v) in the map and `depthMetres` behind the near side sends towards +z.
inline Vec3 sampleAt(const Lrsm& lrsm, float u, float v, float depthMetres, float radius, const ConeSettings& cones)
{
    static const NormalCdf phi(GaussianMethod::exact);
    const ConeSample sample{Vec3(2.0f * u - 1.0f, 1.0f - 2.0f * v, -(lrsm.projection.depthNear + depthMetres)), radius, Vec3(0, 0, 1)};
    return sampleLrsm(lrsm, sample, cones, phi);
}

}  // namespace lrsm::extremes
