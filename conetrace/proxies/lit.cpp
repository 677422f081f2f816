#include "conetrace/proxies/lit.h"

#include "conetrace/frame/shadow_map.h"
#include "core/base/parallel.h"
#include "core/scene/exposure.h"
#include "core/scene/light.h"

namespace lrsm {
namespace {

constexpr std::size_t kProxiesPerTask = 2048;

float brightness(const Vec3& radiance)
{
    return glm::dot(radiance, Vec3(0.2126f, 0.7152f, 0.0722f));
}

struct ProxyLighter {
    std::vector<LightSampler> samplers;
    std::vector<DepthMapView> depths;
    float biasTexels;

    Vec3 operator()(const Vec3& position, const Vec3& normal, const Vec3& shadingNormal, const Vec3& albedo) const
    {
        Vec3 sum(0.0f);
        for (std::size_t k = 0; k < samplers.size(); ++k) {
            const LightSample light = samplers[k](position);
            const float nDotL = glm::dot(shadingNormal, light.toLight);
            if (light.irradiance == Vec3(0.0f) || !(nDotL > 0.0f && glm::dot(normal, light.toLight) > 0.0f)) continue;
            sum += reflectedRadiance(albedo, light.irradiance, nDotL) * shadowFromMap(depths[k], {position, normal}, biasTexels);
        }
        return sum;
    }
};

struct LitCounts {
    std::uint64_t lit = 0, bothSides = 0;
    ConversionCounts conversions;
};

}  // namespace

Counters countersOf(const ProxyLight& light)
{
    return {{"lit_proxies", double(light.lit)},
            {"proxies_lit_on_both_sides", double(light.bothSides)},
            {"half_saturations", double(light.conversions.halfSaturations)},
            {"nans", double(light.conversions.nans)}};
}

ProxyLight lightProxies(const GatherInput& input, const PointProxies& proxies)
{
    const ProxySettings& settings = input.settings.proxies;
    ProxyLighter lighter{{input.scene.lights.begin(), input.scene.lights.end()}, {}, input.settings.direct.depthBiasTexels};
    for (const Rsm& rsm : input.rsms) lighter.depths.emplace_back(rsm);
    ProxyLight out;
    out.preExposure = preExposureOf(input.scene);
    out.half = settings.storage == Storage::gpu;
    out.radiance.resize(proxies.size());
    out.normals = proxies.normals;

    std::vector<LitCounts> partial(proxies.size() / kProxiesPerTask + 1);
    parallelFor(proxies.size(), kProxiesPerTask, [&](std::size_t begin, std::size_t end) {
        LitCounts& counts = partial[begin / kProxiesPerTask];
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 position = proxies.positions[i], normal = proxies.normals[i], shading = proxies.shadingNormals[i], albedo = proxies.albedos[i];
            Vec3 radiance = lighter(position, normal, shading, albedo);
            if (proxies.doubleSided[i]) {
                const Vec3 behind = lighter(position, -normal, -shading, albedo);
                counts.bothSides += radiance != Vec3(0.0f) && behind != Vec3(0.0f) ? 1 : 0;
                if (brightness(behind) > brightness(radiance)) {
                    radiance = behind;
                    out.normals[i] = -normal;
                }
            }
            radiance *= out.preExposure;
            if (out.half)
                for (int c = 0; c < 3; ++c) radiance[c] = roundToHalf(radiance[c], settings.halfRounding, counts.conversions);
            counts.lit += radiance != Vec3(0.0f) ? 1 : 0;
            out.radiance[i] = radiance;
        }
    });
    for (const LitCounts& counts : partial) {
        out.lit += counts.lit;
        out.bothSides += counts.bothSides;
        out.conversions += counts.conversions;
    }
    return out;
}

}  // namespace lrsm
