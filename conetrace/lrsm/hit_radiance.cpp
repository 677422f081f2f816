#include "conetrace/lrsm/hit_radiance.h"

#include "conetrace/lrsm/march_slab.h"
#include "lrsm/sample.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace {

/// The probe as one light sees it.
struct ProbeInLight {
    LrsmFootprint taps;
    Vec3 toLight, direction;
    float depthMetres, footprint;
};

/// Signs of a direction as MapView numbers them.
int octantOf(const Vec3& d)
{
    return (d.x < 0.0f ? 1 : 0) | (d.y < 0.0f ? 2 : 0) | (d.z < 0.0f ? 4 : 0);
}

/// Where in a group's cells a lookup at this level lies. The coarser of two blended levels answers for both.
std::size_t cellOf(const MapView& map, float u, float v, float level)
{
    const float lod = std::clamp(level, 0.0f, static_cast<float>(map.lrsm.levels() - 1));
    const int whole = static_cast<int>(lod), coarse = whole + (lod > static_cast<float>(whole) ? 1 : 0);
    const int size = map.lrsm.resolutionAt(coarse);
    const auto place = [&](float coordinate) { return std::clamp(detail::floorToInt(coordinate * static_cast<float>(size) - 0.5f) + 1, 0, size); };
    return static_cast<std::size_t>(map.firstCells[static_cast<std::size_t>(coarse)] + place(v) * (size + 1) + place(u));
}

/// A R of one layer times V; 0 where it holds nothing, or only surfaces that face away.
Vec3 layerRadiance(const Lrsm& lrsm, int layer, const ProbeInLight& at, const NormalCdf& phi)
{
    const LrsmTexel* texels = layerTexels(lrsm, layer);
    const Float4 normalSum = sampleNormal(texels, at.taps);
    const Vec3 normal(normalSum[0], normalSum[1], normalSum[2]);
    if (!(normalSum[3] > 0.0f && glm::dot(normal, at.direction) < 0.0f)) return Vec3(0.0f);
    const Float4 depth = sampleDepth(texels, at.taps);
    if (!(depth[2] > 0.0f)) return Vec3(0.0f);

    // Eq. 10, 11 in metres.
    const LayerRange& layerRange = lrsm.ranges[static_cast<std::size_t>(layer)];
    const float range = lrsm.projection.depthRange(), scale = (layerRange.depthMax - layerRange.depthMin) * range;
    const DepthMoments moments = depthMoments({.depth = depth[0], .depthSquared = depth[1], .depthAlpha = depth[2]}, 0.0f);
    const float sigma = std::sqrt(moments.variance * scale * scale + 0.25f * at.footprint * at.footprint);
    const float fromMean = at.depthMetres - (layerRange.depthMin * range + moments.mean * scale);

    // Eq. 12.
    const float nDotL = glm::dot(normal, at.toLight) / glm::length(normal);
    const float h = 1.5f * at.footprint / std::max(nDotL, kLeastLightCosine);
    if (std::abs(fromMean) > h + kCdfLimit * sigma) return Vec3(0.0f);
    const float visibility = phi((fromMean + h) / sigma) - phi((fromMean - h) / sigma);
    const Float4 radiance = sampleRadiance(texels, at.taps);
    return visibility * Vec3(radiance[0], radiance[1], radiance[2]);
}

}  // namespace

Vec3 lrsmRadiance(const MapView& map, const LrsmProbe& probe, const ConeSettings& settings, const NormalCdf& phi, std::uint64_t& samples)
{
    const Lrsm& lrsm = map.lrsm;
    const LightSpacePoint point = projectToLight(lrsm.projection, probe.position);
    if (!point.valid) return Vec3(0.0f);
    const float footprint = std::max(probe.footprint, 2.0f * point.texelSize);  // an LRSM texel is two RSM texels wide
    const float level = lrsmLevel(footprint, point.texelSize, settings.gather.rsmLevelBias, settings.gather.rsmMinLevel);
    const LrsmFootprint taps = makeFootprint(lrsm, point.u, point.v, level, settings.march.filterFraction);
    if (outsideMap(taps)) return Vec3(0.0f);
    const ProbeInLight at{.taps = taps,
                          .toLight = directionToLight(lrsm.projection, probe.position),
                          .direction = probe.direction,
                          .depthMetres = point.depth * lrsm.projection.depthRange(),
                          .footprint = footprint};

    Vec3 sum(0.0f);
    const std::size_t facing = cellOf(map, point.u, point.v, level) * 8 + static_cast<std::size_t>(octantOf(probe.direction));
    for (int layer = 0; layer < lrsm.layers(); ++layer) {
        if (!(map.facingOf(layer / MapView::kGroup)[facing] >> (layer % MapView::kGroup) & 1)) continue;
        const float share = settings.gather.layerSelection == LayerSelection::touched ? 1.0f : decay(lrsm.ranges[std::size_t(layer)], point.depth);
        if (!(share > 0.0f)) continue;
        ++samples;
        sum += share * layerRadiance(lrsm, layer, at, phi);
    }
    return sum;
}

}  // namespace lrsm
