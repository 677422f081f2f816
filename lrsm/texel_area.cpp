#include "lrsm/texel_area.h"

#include <algorithm>

namespace lrsm {

Vec3 texelPosition(const Rsm& rsm, std::size_t texel)
{
    const auto n = static_cast<std::size_t>(rsm.projection.resolution);
    const float u = (float(texel % n) + 0.5f) / float(n), v = (float(texel / n) + 0.5f) / float(n);
    return unprojectFromLight(rsm.projection, u, v, rsm.depthLinear.texels[texel]);
}

float texelArea(const Rsm& rsm, std::size_t texel)
{
    const Vec3 p = texelPosition(rsm, texel);
    const float edge = projectToLight(rsm.projection, p).texelSize;
    const float axial = glm::dot(-directionToLight(rsm.projection, p), rsm.projection.forward);
    return edge * edge * axial / std::max(rsm.texels.texels[texel].nDotL, kLeastTexelCosine);
}

}  // namespace lrsm
