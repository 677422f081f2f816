// Dachsbacher and Stamminger, "Reflective Shadow Maps", I3D 2005.
#include "lrsm/rsm.h"

#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "core/raster/draw_scene.h"
#include "core/scene/check_scene.h"
#include "core/scene/exposure.h"
#include "core/scene/light.h"
#include "lrsm/casters.h"

#include <bit>
#include <cassert>

namespace lrsm {

namespace {

struct ShadedTexel {
    RsmTexel texel;
    float depth = 1.0f;
};

/// Reflected radiance of a diffuse surface at `pWorld`, `place` in the map, lit by the light alone: rho L_d <n.l> / pi.
ShadedTexel shadeTexel(const Scene& scene, const LightSampler& light, const LightProjection& projection, const SurfaceHit& hit, const Vec3& pWorld,
                       const LightSpacePoint& place, TextureFilter filter)
{
    const Vec3 toLight = directionToLight(projection, pWorld);
    const PixelSpacing spacing{projection.right * place.texelSize, -projection.up * place.texelSize};
    const Surface surface = evaluateSurface(scene, hit, toLight, filter == TextureFilter::trilinear ? &spacing : nullptr);
    const float nDotL = glm::clamp(glm::dot(surface.normal, toLight), 0.0f, 1.0f);

    ShadedTexel shaded;
    shaded.texel.radiance = reflectedRadiance(surface.albedo, light(surface.position).irradiance, nDotL);
    shaded.texel.coverage = 1.0f;
    shaded.texel.normal = surface.normal;
    shaded.texel.nDotL = nDotL;
    shaded.depth = glm::clamp(place.depth, 0.0f, 1.0f);
    return shaded;
}

bool coversPart(const Scene& scene, const RsmSettings& settings)
{
    return settings.extent == Extent::reach && reachIsPart(scene);
}

/// Farther than the range that the map was fitted to: it stays empty there, so that what lies beyond is lit and reflects nothing.
bool isBeyond(const LightSpacePoint& place)
{
    constexpr float kRounding = 0x1p-16f;
    return place.depth > 1.0f + kRounding;
}

void toHalf(RsmTexel& texel, HalfRounding rounding, ConversionCounts& counts)
{
    for (int k = 0; k < 3; ++k) texel.radiance[k] = roundToHalf(texel.radiance[k], rounding, counts);
    for (int k = 0; k < 3; ++k) texel.normal[k] = roundToHalf(texel.normal[k], rounding, counts);
    texel.nDotL = roundToHalf(texel.nDotL, rounding, counts);
}

}  // namespace

Counters countersOf(const Rsm& rsm)
{
    Counters counters = countersOf(rsm.raster);
    counters.push_back({"half_saturations", static_cast<double>(rsm.conversions.halfSaturations)});
    counters.push_back({"nans", static_cast<double>(rsm.conversions.nans)});
    return counters;
}

LightProjection projectionOf(const Scene& scene, const Light& light, const RsmSettings& settings)
{
    if (!coversPart(scene, settings)) return fitLightProjection(light, scene.bounds, settings.resolution, settings.snap);
    return fitLightProjection(light, scene.reach, withCasters(scene.reach, scene, light), settings.resolution, settings.snap);
}

Rsm renderRsm(const Scene& scene, const Light& light, const Requirements& needs, const RsmSettings& settings, TextureFilter textureFilter)
{
    assert(std::has_single_bit(static_cast<unsigned>(settings.resolution)) && settings.resolution >= 2);
    checkBounds(scene.bounds);
    checkLight(light);
    checkMaterials(scene);
    Rsm rsm;
    requireMemory(Rsm::predictBytes(settings.resolution) + std::size_t(settings.resolution) * std::size_t(settings.resolution) * sizeof(Fragment),
                  "reflective shadow map of light \"" + light.name + "\"", "lower rsm_resolution, or take fewer lights");
    const bool part = coversPart(scene, settings);
    rsm.projection = projectionOf(scene, light, settings);
    const int n = rsm.projection.resolution;
    const SceneFragments drawn = drawScene(scene, clipFromWorld(rsm.projection), needs, n, n);
    rsm.raster = drawn.counts;
    rsm.texels = Image<RsmTexel>(n, n);
    rsm.depthLinear = Image<float>(n, n, 1.0f);

    rsm.preExposure = preExposureOf(scene);
    const LightSampler sampler(light);
    constexpr std::size_t kChunk = 8192;
    const std::size_t count = rsm.texels.texels.size();
    std::vector<ConversionCounts> counts((count + kChunk - 1) / kChunk);
    parallelFor(count, kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Fragment& fragment = drawn.fragments.texels[i];
            if (fragment.triangle == kNoTriangle) continue;
            const SurfaceHit hit = hitOf(drawn.firstTriangle, fragment);
            const Vec3 pWorld = positionOf(scene, hit);
            const LightSpacePoint place = projectToLight(rsm.projection, pWorld);
            if (part && isBeyond(place)) continue;
            ShadedTexel shaded = shadeTexel(scene, sampler, rsm.projection, hit, pWorld, place, textureFilter);
            shaded.texel.radiance *= rsm.preExposure;
            if (settings.storage == Storage::gpu) toHalf(shaded.texel, settings.halfRounding, counts[begin / kChunk]);
            rsm.texels.texels[i] = shaded.texel;
            rsm.depthLinear.texels[i] = shaded.depth;
        }
    });
    for (const ConversionCounts& c : counts) rsm.conversions += c;
    return rsm;
}

}  // namespace lrsm
