#pragma once

#include "conetrace/frame/cone.h"
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

/// Keeps the results of one pixel's cones, one after the other, where they are asked for.
struct ConeKeeper {
    Vec4* next = nullptr;  ///< none: nothing is kept
    std::size_t stride = 0;
    void result(const ConeResult& cone)
    {
        if (!next) return;
        *next = Vec4(cone.radiance, cone.opacity);
        next += stride;
    }
};
/// `record` may be null.
inline ConeKeeper diffuseKeeper(ConeRecord* record, std::size_t pixel)
{
    if (!record) return {};
    return {record->diffuse.data() + pixel, record->diffuse.size() / std::size_t(record->cones)};
}
inline ConeKeeper specularKeeper(ConeRecord* record, std::size_t pixel)
{
    if (!record) return {};
    return {record->specular.texels.data() + pixel, 0};
}

}  // namespace lrsm
