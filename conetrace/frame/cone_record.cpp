#include "conetrace/frame/cone_record.h"

namespace lrsm {

ConeRecord::ConeRecord(const GBuffer& gbuffer, const Requirements& needs, const ConeSettings& settings)
    : cones(settings.set.count * settings.set.setsPerPixel),
      diffuse(static_cast<std::size_t>(cones) * gbuffer.position.texels.size(), Vec4(0.0f)),
      specular(needs.specular ? Image<Vec4>(gbuffer.width, gbuffer.height, Vec4(0.0f)) : Image<Vec4>())
{
}

}  // namespace lrsm
