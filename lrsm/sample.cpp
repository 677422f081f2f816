// Algorithm 1 of Sugihara, Rauwendaal, Salvi: Layered Reflective Shadow Maps for Voxel-based Indirect Illumination, HPG 2014.
#include "lrsm/sample.h"

namespace lrsm {
namespace {

/// A cone sample as the light sees it.
struct LightSpaceSample {
    float depth;   ///< z_c, linear depth of the light
    float window;  ///< half the depth interval of Eq. 12, in the same unit
    const LrsmFootprint& footprint;
};

/// One layer's part of Eq. 14, weighted by f. Stops at the first factor that is 0, as Algorithm 1 does.
LayerTerms evaluateLayer(const Lrsm& lrsm, int layer, float f, const LightSpaceSample& at, const Vec3& toReceiver, const ConeSettings& settings,
                         const NormalCdf& phi)
{
    LayerTerms terms;
    terms.layer = layer;
    terms.decay = f;
    const FilteredTexel texel = sampleLayer(lrsm, layer, at.footprint);
    if (!(texel.depthAlpha > 0.0f)) return terms;
    terms.alpha = texel.depthAlpha;
    terms.radiance = texel.radiance;

    // Eq. 8, backface culling.
    terms.normal = backfaceWeight(normalTerm(texel, toReceiver), settings.gather.backface);
    if (!(terms.normal > 0.0f)) return terms;

    // Eq. 10-12, in the layer's warped depth.
    const DepthMoments moments = depthMoments(texel);
    terms.mean = moments.mean;
    terms.variance = moments.variance;
    const LayerRange& range = lrsm.ranges[static_cast<std::size_t>(layer)];
    const float window = at.window / (range.depthMax - range.depthMin);
    terms.visibility = gaussianVisibility(phi, moments.mean, moments.variance, warpDepth(range, at.depth), window);

    // Eq. 14.
    terms.outgoing = texel.radiance * (f * terms.visibility * terms.normal);
    return terms;
}

}  // namespace

Vec3 sampleLrsm(const Lrsm& lrsm, const ConeSample& sample, const ConeSettings& settings, const NormalCdf& phi, std::vector<LayerTerms>* terms)
{
    const LightSpacePoint p = projectToLight(lrsm.projection, sample.centre);
    if (!p.valid || !(p.u >= 0.0f && p.u <= 1.0f && p.v >= 0.0f && p.v <= 1.0f)) return Vec3(0.0f);

    const float level = lrsmLevel(2.0f * sample.radius, p.texelSize, settings.gather.rsmLevelBias, settings.gather.rsmMinLevel);
    const LrsmFootprint footprint = makeFootprint(lrsm, p.u, p.v, level, settings.march.filterFraction);
    const LightSpaceSample at{p.depth, sample.radius * settings.gather.vRadiusScale / lrsm.projection.depthRange(), footprint};
    const bool centred = settings.gather.layerSelection == LayerSelection::centre;

    Vec3 outgoing(0.0f);
    for (int layer = 0; layer < lrsm.layers(); ++layer) {
        const LayerRange& range = lrsm.ranges[static_cast<std::size_t>(layer)];
        const float f = centred ? decay(range, at.depth) : touches(range, at.depth, at.window) ? 1.0f : 0.0f;
        if (!(f > 0.0f)) continue;
        const LayerTerms layerTerms = evaluateLayer(lrsm, layer, f, at, sample.toReceiver, settings, phi);
        outgoing += layerTerms.outgoing;
        if (terms) terms->push_back(layerTerms);
    }
    return outgoing;
}

}  // namespace lrsm
