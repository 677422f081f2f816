#pragma once

#include "apps/validate/equations/synthetic_maps.h"
#include "apps/validate/extremes/catalogue.h"
#include "lrsm/sample.h"

namespace lrsm::extremes {

/// A reflective shadow map made by hand: an orthographic light at z = 0 that looks along -z, 2 m wide, depths over `range` metres from `nearMetres` on.
template <class Texel>
Rsm syntheticMap(int resolution, Texel&& texel, float range = 1.0f, float nearMetres = 0.0f)
{
    LightProjection projection = plainProjection(resolution);
    projection.depthNear = nearMetres;
    projection.depthFar = nearMetres + range;
    return lrsm::syntheticMap(projection, texel);
}

inline LayerSettings layerSettings(Mode mode, int depthLayers = 2, int normalLayers = 2, float overlap = 0.0f)
{
    LayerSettings settings = layersOf(depthLayers, normalLayers, overlap, mode == Mode::float32 ? Storage::float32 : Storage::gpu);
    settings.halfRounding = mode == Mode::gpuNearestEven ? HalfRounding::nearestEven : HalfRounding::d3d;
    return settings;
}

/// Algorithm 1 as printed, all layers that hold z_c.
inline ConeSettings paperCones()
{
    ConeSettings cones;
    cones.march.estimator = Estimator::paper;
    cones.gather.layerSelection = LayerSelection::centre;
    cones.gather.backface = Backface::cosine;
    cones.gather.gaussian = GaussianMethod::exact;
    return cones;
}

/// What a sample at (u, v) in the map and `depthMetres` behind the near side sends towards +z.
inline Vec3 sampleAt(const Lrsm& lrsm, float u, float v, float depthMetres, float radius, const ConeSettings& cones)
{
    static const NormalCdf phi(GaussianMethod::exact);
    const ConeSample sample{Vec3(2.0f * u - 1.0f, 1.0f - 2.0f * v, -(lrsm.projection.depthNear + depthMetres)), radius, Vec3(0, 0, 1)};
    return sampleLrsm(lrsm, sample, cones, phi);
}

/// A uniform map of this radiance, stored and sampled: what comes back over what went in, less 1.
inline double radianceError(Mode mode, double radiance, Probe* probe = nullptr)
{
    const Lrsm lrsm = buildLrsm(flatMap(plainProjection(16), {.radiance = Vec3(float(radiance))}), layerSettings(mode, 1, 1));
    if (probe) probe->output("lrsm", lrsm);
    return double(sampleAt(lrsm, 0.5f, 0.5f, 0.5f, 0.25f, paperCones()).x) / radiance - 1.0;
}

/// What a map of n^2 texels, one of them lit, leaves at the chain's top.
inline FilteredTexel topOfLoneTexel(Mode mode, int n, Probe* probe = nullptr)
{
    const Lrsm lrsm =
        buildLrsm(syntheticMap(n, [n](int x, int y) { return MapTexel{.coverage = x == n / 3 && y == n / 2 ? 1.0f : 0.0f}; }), layerSettings(mode));
    if (probe) {
        probe->output("lrsm", lrsm);
        probe->require(isFinite(sampleAt(lrsm, 0.5f, 0.5f, 0.5f, 1.0f, paperCones())), "the sample is not finite");
    }
    return sampleLayer(lrsm, 0, 0.5f, 0.5f, 99.0f, FilterFraction::exact);
}

}  // namespace lrsm::extremes
