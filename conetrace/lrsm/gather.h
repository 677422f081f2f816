#pragma once

#include "conetrace/frame/gbuffer.h"
#include "conetrace/lrsm/march.h"
#include "core/scene/requirements.h"

namespace lrsm {

/// Final gathering (Sec. 3.2): what the cones of every pixel bring in.
struct Gathered {
    Image<Vec3> irradiance;  ///< pi * sum of weight * I over the diffuse cones, W/m^2
    Image<Vec3> specular;    ///< I of the specular cone, W/(m^2 sr); empty when the scene has no specular part
    Image<float> opacity;    ///< weighted mean opacity of the diffuse cones
    ConeCounts counts;

    std::size_t byteSize() const { return irradiance.byteSize() + specular.byteSize() + opacity.byteSize(); }
};

/// What each cone brought in, for captures. 0 where nothing was drawn.
struct ConeRecord {
    int cones = 0;              ///< diffuse cones a pixel: count * setsPerPixel
    std::vector<Vec4> diffuse;  ///< I (rgb) and opacity, [cone * pixels + pixel]; cones in the order of their sum
    Image<Vec4> specular;       ///< the same of the specular cone; empty when the scene has no specular part
};

/// Traces the cones of all covered pixels, parallel over 16x16 tiles; the same bits for any number of threads.
/// `opacity` and `lrsms` are the world; `eye` decides the mirror direction. `record`, when given, is filled besides.
Gathered traceCones(const GBuffer& gbuffer, const Camera& camera, const OpacityPyramid& opacity, const std::vector<Lrsm>& lrsms, const Requirements& needs,
                    const ConeSettings& settings, ConeRecord* record = nullptr);

/// Text of how one pixel's cones went, step by step: what `--pixel` prints.
std::string explainCones(const GBuffer& gbuffer, const Camera& camera, const OpacityPyramid& opacity, const std::vector<Lrsm>& lrsms, const Requirements& needs,
                         const ConeSettings& settings, int x, int y);

}  // namespace lrsm
