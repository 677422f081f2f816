#include "apps/validate/ladder/filtered_radiance.h"

namespace lrsm {

glm::dvec3 filteredRadiance(const Lrsm& lrsm, const ConeSample& sample, const ConeSettings& settings, double varianceFloor)
{
    const LightSpacePoint at = projectToLight(lrsm.projection, sample.centre);
    if (!at.valid || !(at.u >= 0.0f && at.u <= 1.0f && at.v >= 0.0f && at.v <= 1.0f)) return glm::dvec3(0.0);
    const float level = lrsmLevel(2.0f * sample.radius, at.texelSize, settings.rsmLevelBias, settings.rsmMinLevel);
    const LrsmFootprint footprint = makeFootprint(lrsm, at.u, at.v, level, FilterFraction::exact);
    const TermSettings terms = TermSettings::of(settings);
    const double window = double(sample.radius) * terms.vRadiusScale / double(lrsm.projection.depthRange());

    glm::dvec3 sum(0.0);
    for (int layer = 0; layer < lrsm.layers(); ++layer) {
        const LayerRange& range = lrsm.ranges[std::size_t(layer)];
        const double share = terms.selection == LayerSelection::centre              ? double(decay(range, at.depth))
                             : touches(range, at.depth, static_cast<float>(window)) ? 1.0
                                                                                    : 0.0;
        if (!(share > 0.0)) continue;
        const FilteredTexel texel = sampleLayer(lrsm, layer, footprint);
        if (!(texel.depthAlpha > 0.0f && texel.normalAlpha > 0.0f)) continue;
        const glm::dvec3 normal(texel.normal), toReceiver(sample.toReceiver);
        const double facing = facingTerm(terms, glm::dot(normal, toReceiver) / double(texel.normalAlpha));
        const double mean = double(texel.depth) / double(texel.depthAlpha);
        const double variance = std::max(double(texel.depthSquared) / double(texel.depthAlpha) - mean * mean, varianceFloor);
        const double width = double(range.depthMax) - double(range.depthMin);
        const double zc = (double(at.depth) - double(range.depthMin)) / width;
        sum += glm::dvec3(texel.radiance) * (share * facing * gaussianShare(zc - mean, variance, window / width));
    }
    return sum;
}

}  // namespace lrsm
