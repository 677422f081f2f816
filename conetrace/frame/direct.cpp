#include "conetrace/frame/direct.h"

#include "conetrace/frame/shadow_map.h"
#include "conetrace/frame/shadow_rays.h"
#include "core/base/elementary.h"
#include "core/base/parallel.h"
#include "core/scene/brdf.h"
#include "core/scene/light.h"
#include "voxel/cascades.h"

#include <cassert>

namespace lrsm {

namespace {

// A conservatively voxelized plane reaches up to one voxel above itself, and the trilinear filter half a voxel further.
constexpr float kNormalOffsetVoxels = 1.5f;
constexpr float kStartVoxels = 1.0f;
constexpr float kTransmittanceCutoff = 0.01f;

/// What is left of the transmittance after half a sphere diameter more of the cone. Area densities add up (surfaces rarely overlap as seen
/// from the receiver: a wall of density 1 is just opaque); opacities of the isotropic pyramid multiply.
float attenuate(float transmittance, const OpacityPyramid& opacity, const Vec3& centre, const Vec3& direction, float diameter)
{
    const Vec3 sample = sampleOpacity(opacity, centre, fastLog2(diameter), FilterFraction::exact);
    if (opacity.axes == OpacityAxes::directional) return std::max(0.0f, transmittance - glm::dot(glm::abs(direction), sample) * 0.5f * diameter);
    return transmittance * std::sqrt(1.0f - std::min(1.0f, sample.x));  // two such steps make the sphere's own opacity
}

Surface surfaceAt(const GBuffer& gbuffer, std::size_t i)
{
    Surface surface;
    surface.position = gbuffer.position.texels[i];
    surface.geometricNormal = gbuffer.geometricNormal.texels[i];
    surface.normal = gbuffer.normal.texels[i];
    surface.albedo = gbuffer.albedo.texels[i];
    if (!gbuffer.roughness.empty()) {
        surface.specularColor = gbuffer.specularColor.texels[i];
        surface.roughness = gbuffer.roughness.texels[i];
    }
    return surface;
}

struct Shadowing {
    std::span<const DepthMapView> maps;
    const OpacityPyramid* opacity;
    const DirectSettings& settings;
    float tanHalfAperture = 0.0f;
    std::vector<Image<std::uint8_t>> rays;  ///< a light

    float visibility(std::size_t light, std::size_t pixel, const Surface& surface, const LightSample& sample) const
    {
        const ShadowReceiver receiver{surface.position, surface.geometricNormal};
        switch (settings.shadows) {
        case Shadows::exact: return float(rays[light].texels[pixel]);
        case Shadows::hard: return shadowFromMap(maps[light], receiver, settings.depthBiasTexels);
        case Shadows::pcf: return shadowFromMapFiltered(maps[light], receiver, settings.depthBiasTexels, settings.pcfWidthTexels);
        case Shadows::cone: return shadowFromCone(*opacity, surface.position, surface.geometricNormal, sample.toLight, sample.distance, tanHalfAperture);
        case Shadows::off: break;
        }
        return 1.0f;
    }
};

Vec3 shade(const std::vector<LightSampler>& lights, std::size_t pixel, const Surface& surface, const Vec3& toEye, bool specular, const Shadowing& shadowing)
{
    Vec3 radiance(0.0f);
    for (std::size_t k = 0; k < lights.size(); ++k) {
        const LightSample sample = lights[k](surface.position);
        const float nDotL = glm::dot(surface.normal, sample.toLight);
        if (sample.irradiance == Vec3(0.0f) || nDotL <= 0.0f || glm::dot(surface.geometricNormal, sample.toLight) <= 0.0f) continue;
        const float visibility = shadowing.visibility(k, pixel, surface, sample);
        if (visibility == 0.0f) continue;

        Vec3 reflected = surface.albedo * (nDotL / kPi);
        if (specular) reflected += evaluateSpecular(surface, sample.toLight, toEye);
        radiance += sample.irradiance * reflected * visibility;
    }
    return radiance;
}

}  // namespace

float shadowConeTanHalf(const DirectSettings& settings)
{
    return static_cast<float>(tangent(double(settings.shadowConeApertureDegrees) * (0.5 * 3.14159265358979323846 / 180.0)));
}

float shadowFromCone(const OpacityPyramid& finest, const Vec3& pWorld, const Vec3& nGeometric, const Vec3& toLight, float distance, float tanHalfAperture)
{
    constexpr float kHalf = 0.5f;
    const OpacityPyramid& opacity = cascadeAt(finest, cascadeOfReceiver(finest, pWorld, kHalf));
    const VoxelGrid& grid = opacity.base.grid;
    const Vec3 origin = grid.voxelsFromWorld(pWorld) + nGeometric * kNormalOffsetVoxels;
    const VoxelBox box = outermostBox(opacity);
    const float end = std::min(distance / grid.voxelSize, boxExit(origin, toLight, box.low, box.high));

    float transmittance = 1.0f;
    for (float t = kStartVoxels; t < end && transmittance > kTransmittanceCutoff;) {
        const float diameter = std::max(1.0f, 2.0f * tanHalfAperture * t);
        transmittance = attenuate(transmittance, opacity, origin + toLight * t, toLight, diameter);
        t += 0.5f * diameter;
    }
    return transmittance > kTransmittanceCutoff ? transmittance : 0.0f;
}

DirectResult traceDirect(const GBuffer& gbuffer, const Scene& scene, const Camera& camera, std::span<const DepthMapView> maps, const OpacityPyramid* opacity,
                         const Requirements& needs, const DirectSettings& settings)
{
    assert(!readsDepthMaps(settings) || maps.size() == scene.lights.size());
    assert(settings.shadows != Shadows::cone || opacity);
    Shadowing shadowing{.maps = maps, .opacity = opacity, .settings = settings, .tanHalfAperture = shadowConeTanHalf(settings), .rays = {}};
    if (settings.shadows == Shadows::exact)
        for (const Light& light : scene.lights) shadowing.rays.push_back(traceShadowRays(scene, gbuffer, light, needs));

    const std::vector<LightSampler> lights(scene.lights.begin(), scene.lights.end());

    DirectResult result{Image<Vec3>(gbuffer.width, gbuffer.height)};
    parallelFor(result.radiance.texels.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!gbuffer.covered(i)) continue;
            const Surface surface = surfaceAt(gbuffer, i);
            const Vec3 toEye = directionToEye(camera, surface.position);
            result.radiance.texels[i] = shade(lights, i, surface, toEye, needs.specular, shadowing);
        }
    });
    return result;
}

}  // namespace lrsm
