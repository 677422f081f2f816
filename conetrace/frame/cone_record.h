#pragma once

#include "conetrace/frame/gbuffer.h"
#include "core/scene/requirements.h"
#include "core/settings/settings.h"

#include <vector>

namespace lrsm {

/// What each cone brought in, for captures. 0 where nothing was drawn.
struct ConeRecord {
    ConeRecord() = default;
    ConeRecord(const GBuffer& gbuffer, const Requirements& needs, const ConeSettings& settings);  ///< all 0

    int cones = 0;              ///< diffuse cones a pixel: count * setsPerPixel
    std::vector<Vec4> diffuse;  ///< I (rgb) and opacity, [cone * pixels + pixel]; cones in the order of their sum
    Image<Vec4> specular;       ///< the same of the specular cone; empty when the scene has no specular part
};

}  // namespace lrsm
