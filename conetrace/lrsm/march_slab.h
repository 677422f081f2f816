#pragma once

#include "conetrace/lrsm/march.h"

#include <optional>

/// The `slab` estimator: Eq. 1 as an emission integral.
///
/// An RSM texel of solid angle dw is a surface element r^2 dw / <n.l>, which a cone along -v sees as r^2 dw <n.v> / <n.l>. With depths distributed as
/// N(mu, s^2), the emission density along the cone is R (<n.v> / <n.l>) N(z; mu, s^2): while the sample moves by dt, its light depth relative
/// to the surface's tangent plane moves by g dt, g = <n.v> / <n.l>, so the integral over a segment of length dt is exactly
///
///     w = Phi((z_c - mu + g dt / 2) / s) - Phi((z_c - mu - g dt / 2) / s),      I = sum over segments of T w A R,
///
/// one term for both V and N. The w of consecutive segments telescope: while s is constant, an infinite wall gives exactly L for any step or angle
/// (docs/pipeline.md says how near the rest comes).
/// Opacity is area density: a wall covers each ray once, coverage adds, and T = max(0, 1 - integral of density).
namespace lrsm {

/// Rates are capped where light grazes the surface: g = <n.v> / <n.l>.
inline constexpr float kLeastLightCosine = 1e-3f;
/// Beyond as many sigmas a layer has nothing in a segment.
inline constexpr float kNegligibleSigmas = 6.0f;

/// F at distance t, by linear interpolation in the segments done so far (`last` is the current one).
inline float opticalDepthAt(const MarchSchedule& schedule, const std::vector<float>& opticalDepth, std::size_t last, float t)
{
    std::size_t i = last;
    while (i > 0 && schedule.steps[i].begin > t) --i;
    const MarchStep& segment = schedule.steps[i];
    const float before = i > 0 ? opticalDepth[i - 1] : 0.0f;
    const float fraction = std::clamp((t - segment.begin) / (segment.end - segment.begin), 0.0f, 1.0f);
    return before + (opticalDepth[i] - before) * fraction;
}

/// Emission of one light's layers within one segment, weighted by the transmittance just before the emitter's own voxels.
template <class Recorder>
Vec3 slabEmission(const ConeWorld& world, int light, const ConeRay& ray, const Vec3& pWorld, const MarchSchedule& schedule, std::size_t index,
                  const MarchScratch& scratch, ConeCounts& counts, Recorder& recorder)
{
    const ConeSettings& settings = world.settings;
    const Lrsm& lrsm = world.lrsms[std::size_t(light)];
    if (lrsm.layers() == 0) return Vec3(0.0f);
    const LightSpacePoint at = projectToLight(lrsm.projection, pWorld);
    if (!at.valid) return Vec3(0.0f);

    const MarchStep& step = schedule.steps[index];
    const float voxelSize = world.opacity.base.grid.voxelSize;
    const float tap = step.tapWidth * voxelSize, segment = (step.end - step.begin) * voxelSize;
    const float range = lrsm.projection.depthRange(), zc = at.depth * range;  // metres beyond depthNear
    const float window = (0.5f * segment + 0.5f * kKernelReachTaps * tap) / range;
    const Vec3 toLight = directionToLight(lrsm.projection, pWorld);

    Vec3 emission(0.0f);
    std::optional<LrsmFootprint> footprint;
    for (int layer = 0; layer < lrsm.layers(); ++layer) {
        const LayerRange& bounds = lrsm.ranges[std::size_t(layer)];
        if (at.depth + window < bounds.depthMin || at.depth - window > bounds.depthMax) continue;
        if (!footprint) {
            footprint = makeFootprint(lrsm, at.u, at.v, lrsmLevel(tap, at.texelSize, settings.gather.rsmLevelBias, settings.gather.rsmMinLevel),
                                      settings.march.filterFraction);
            if (outsideMap(*footprint)) return Vec3(0.0f);
        }
        ++counts.lrsmSamples;

        // The three textures are read one after the other: most samples are decided by depth or normal alone.
        const LrsmTexel* texels = layerTexels(lrsm, layer);
        const Float4 depth = sampleDepth(texels, *footprint);
        if (!(depth[2] > 0.0f)) continue;
        const Float4 normalSum = sampleNormal(texels, *footprint);
        if (!(normalSum[3] > 0.0f)) continue;

        // Rate at which the sample crosses the surface; culled when it faces away.
        const Vec3 normal = Vec3(normalSum[0], normalSum[1], normalSum[2]) / normalSum[3];
        const float nDotV = -glm::dot(normal, ray.direction);
        if (!(nDotV > 0.0f)) continue;
        const float rate = nDotV / std::max(glm::dot(normal, toLight), kLeastLightCosine);

        // The layer's depths (Eq. 10, 11), in metres, blurred by the tap's own width.
        const float warpedMean = depth[0] / depth[2];
        const float warpedVariance = std::max(0.0f, depth[1] / depth[2] - warpedMean * warpedMean);
        const float scale = (bounds.depthMax - bounds.depthMin) * range;
        const float mean = bounds.depthMin * range + warpedMean * scale;
        const float sigma = std::sqrt(warpedVariance * scale * scale + 0.25f * tap * tap);
        const float e0 = zc - mean, h = 0.5f * rate * segment;
        if (std::abs(e0) - h > kNegligibleSigmas * sigma) continue;
        const float weight = world.phi((e0 + h) / sigma) - world.phi((e0 - h) / sigma);

        // The emitter's own voxels must not dim it: transmittance is taken in front of them.
        const float slant = std::max(nDotV / glm::length(normal), settings.gather.emitterSlantCap);
        const float delay = (settings.gather.emitterDelayTaps * step.tapWidth + settings.gather.emitterDelayVoxels) / slant;
        const float transmittance = transmittanceOf(opticalDepthAt(schedule, scratch.opticalDepth, index, step.middle - delay), settings);
        if (!(transmittance > 0.0f)) continue;

        const Float4 radianceSum = sampleRadiance(texels, *footprint);
        const Vec3 radiance(radianceSum[0], radianceSum[1], radianceSum[2]);
        const Vec3 outgoing = (transmittance * weight) * radiance;
        emission += outgoing;
        if constexpr (RecordsLayers<Recorder>)
            recorder.layer(light, {layer, 1.0f, radiance, depth[2], rate, warpedMean, warpedVariance, weight, outgoing}, transmittance);
    }
    return emission;
}

/// Error of a cone against the same integral in double: of its opacity, and of its radiance over the largest that the map holds. Eq. 11 subtracts two
/// floats: with a layer 80 taps deep instead of fitted to its texels, what that leaves of sigma^2 is seen (the second).
inline constexpr float kMarchSlabMaxError = 3e-5f, kMarchSlabWideMaxError = 8e-4f;

template <class Sampler, class Recorder>
ConeResult marchSlab(const ConeWorld& world, const Sampler& sampler, const ConeRay& ray, const MarchSchedule& schedule, MarchScratch& scratch,
                     ConeCounts& counts, Recorder& recorder)
{
    const ConeSettings& settings = world.settings;
    const VoxelGrid& grid = world.opacity.base.grid;
    const float exit = gridExit(ray.originVoxels, ray.direction, grid.resolution);

    ConeResult result;
    float depth = 0.0f;       // F at the current segment's end
    bool wasOccupied = true;  // the first segments may touch what the receiver stands on
    ++counts.cones;
    for (std::size_t i = 0; i < schedule.steps.size(); ++i) {
        const MarchStep& step = schedule.steps[i];
        if (step.begin - kKernelReachTaps * step.tapWidth > exit) break;
        ++counts.steps;
        const Vec3 offset = ray.direction * step.middle;

        float density = 0.0f;
        bool occupied = true;
        if (step.readVoxels) {
            ++counts.voxelTaps;
            const Vec3 tap = sampler(ray.originVoxels + offset, step.level);
            density = densityAlong(world.opacity, tap, ray.direction);
            occupied = tap.x + tap.y + tap.z > 0.0f;
        }
        depth += density * (step.end - step.begin);
        scratch.opticalDepth[i] = depth;

        const Vec3 pWorld = ray.originWorld + offset * grid.voxelSize;
        if constexpr (Recorder::active) recorder.step({&step, pWorld, density, density * (step.end - step.begin), transmittanceOf(depth, settings)});

        // Where neither this nor the last tap met a voxel there is no surface to emit.
        if (occupied || wasOccupied) {
            if constexpr (RecordsLookups<Recorder>) recorder.lookup(ConeSample{pWorld, 0.5f * step.diameter * grid.voxelSize, -ray.direction});
            for (int light = 0; light < static_cast<int>(world.lrsms.size()); ++light)
                result.radiance += slabEmission(world, light, ray, pWorld, schedule, i, scratch, counts, recorder);
        }
        wasOccupied = occupied;

        // Done when the transmittance is spent for every emitter to come.
        if (transmittanceOf(opticalDepthAt(schedule, scratch.opticalDepth, i, step.settled), settings) < settings.march.transmittanceCutoff) break;
    }
    result.opacity = 1.0f - transmittanceOf(depth, settings);
    return result;
}

}  // namespace lrsm
