#pragma once

#include "lrsm/rsm.h"

namespace lrsm {

/// How far each of a light's rays reaches, and nothing else: what shadows compare with.
struct DepthMap {
    LightProjection projection;
    Image<float> depthLinear;  ///< [0, 1]; 1 where empty
    RasterCounts raster;

    static std::size_t predictBytes(int resolution) { return std::size_t(resolution) * std::size_t(resolution) * sizeof(float); }
};

template <class Visit>
void forEachArray(const DepthMap& map, Visit&& visit)
{
    visit(map.depthLinear.texels, ArrayTraits{map.depthLinear.byteSize()});
}

inline Counters countersOf(const DepthMap& map)
{
    return countersOf(map.raster);
}

/// A depth map, or the depth of an RSM.
struct DepthMapView {
    const LightProjection& projection;
    const Image<float>& depthLinear;
    DepthMapView(const DepthMap& map) : projection(map.projection), depthLinear(map.depthLinear) {}
    explicit DepthMapView(const Rsm& rsm) : projection(rsm.projection), depthLinear(rsm.depthLinear) {}
};

/// The frustum of a light's RSM with `factor` times its texels along an edge.
LightProjection refine(const LightProjection& projection, int factor);

DepthMap renderDepthMap(const Scene& scene, const Light& light, const Requirements& needs, const LightProjection& projection);

}  // namespace lrsm
