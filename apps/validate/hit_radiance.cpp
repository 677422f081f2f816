#include "apps/validate/hit_radiance.h"

#include "lrsm/sample.h"

namespace lrsm {
namespace {

/// V of one layer; 0 where it holds nothing, or only surfaces that face away.
float surfaceVisibility(const FilteredTexel& texel, const LayerRange& layer, float depthRange, float depthMetres, const Vec3& toLight, const Vec3& direction,
                        float footprint, const NormalCdf& phi)
{
    if (!(texel.depthAlpha > 0.0f && texel.normalAlpha > 0.0f)) return 0.0f;
    const float nDotV = -glm::dot(texel.normal, direction), nDotL = glm::dot(texel.normal, toLight) / glm::length(texel.normal);
    if (!(nDotV > 0.0f)) return 0.0f;

    const DepthMoments moments = depthMoments(texel, 0.0f);
    const float scale = (layer.depthMax - layer.depthMin) * depthRange;
    const float sigma = std::sqrt(moments.variance * scale * scale + 0.25f * footprint * footprint);
    const float fromMean = depthMetres - (layer.depthMin * depthRange + moments.mean * scale);
    const float h = 1.5f * footprint / std::max(nDotL, 1e-3f);
    return phi((fromMean + h) / sigma) - phi((fromMean - h) / sigma);
}

}  // namespace

Vec3 lrsmRadiance(const Lrsm& lrsm, const LrsmProbe& probe, const ConeSettings& settings, const NormalCdf& phi)
{
    const LightSpacePoint at = projectToLight(lrsm.projection, probe.position);
    if (!at.valid) return Vec3(0.0f);
    const float range = lrsm.projection.depthRange();
    const Vec3 toLight = directionToLight(lrsm.projection, probe.position);
    const float footprint = std::max(probe.footprint, 2.0f * at.texelSize);  // an LRSM texel is two RSM texels wide
    const float level = lrsmLevel(footprint, at.texelSize, settings.gather.rsmLevelBias, settings.gather.rsmMinLevel);
    const LrsmFootprint taps = makeFootprint(lrsm, at.u, at.v, level, settings.march.filterFraction);

    Vec3 sum(0.0f);
    for (int layer = 0; layer < lrsm.layers(); ++layer) {
        const LayerRange& bounds = lrsm.ranges[std::size_t(layer)];
        const float share = settings.gather.layerSelection == LayerSelection::touched ? 1.0f : decay(bounds, at.depth);
        if (!(share > 0.0f)) continue;
        const FilteredTexel texel = sampleLayer(lrsm, layer, taps);
        sum += (share * surfaceVisibility(texel, bounds, range, at.depth * range, toLight, probe.direction, footprint, phi)) * texel.radiance;
    }
    return sum;
}

}  // namespace lrsm
