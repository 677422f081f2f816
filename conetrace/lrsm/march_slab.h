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
/// Opacity is area density: a wall covers each ray once, coverage adds, and T = max(0, 1 - F), F the integral of density.
///
/// The emitter's own voxels must not dim it. Its tangent plane (unit normal n, c = <n.v>) is crossed at t* = middle - e0 / g, and of what was covered in
/// front of it, F(t* - front), one crossing of that plane is taken back where it lies within `delay` of t*. F is kept by axis, F_a, since the voxels are
/// (|d_a| times the fraction of columns along a that hold one), and so is the crossing: a wall across another axis is never the emitter's own.
///
///     own_a = |d_a| (|n_a| + edge) / c
///     T     = max(0, 1 - sum_a [ F_a(t* - front) - min(F_a(t* - front) - F_a(t* - delay), own_a) ])
///
/// `edge`, one over the voxels along a block's edge, is what a layer one voxel thick shows of its rim.
namespace lrsm {

/// Rates are capped where light grazes the surface: g = <n.v> / <n.l>.
inline constexpr float kLeastLightCosine = 1e-3f;
/// Beyond as many sigmas a layer has nothing in a segment.
inline constexpr float kNegligibleSigmas = 6.0f;

/// Width of a sample's footprint in the LRSM over the cone's diameter there, and the least in voxels. Wider than the kernel of T, and floors lose light to the
/// foot of the wall that they meet; narrower, and the cones of a set leave gaps: chosen with kFrontTaps (docs/pipeline.md).
inline constexpr float kFootprintShare = 0.13f, kLeastFootprintVoxels = 0.5f;
/// F is taken as many taps in front of the crossing: the near half of a tap's kernel.
inline constexpr float kFrontTaps = 1.5f;
/// A block's columns are no longer than 2^3 voxels (voxel/opacity_pyramid.h).
inline constexpr float kLongestColumnVoxels = 8.0f;
/// The way through the emitter's own layer is not taken to be longer than for this cosine.
inline constexpr float kLeastEmitterCosine = 0.05f;

/// Width of the LRSM's footprint, in voxels: that of sigma, too.
inline float footprintVoxels(const MarchStep& step)
{
    return std::max(kLeastFootprintVoxels, kFootprintShare * step.diameter);
}

/// F at distance t, linear over the taps done so far (`done`).
inline Vec3 opticalDepthAt(const std::vector<float>& edges, const std::vector<Vec3>& opticalDepth, int done, float t)
{
    std::size_t i = std::size_t(done);
    while (i > 1 && edges[i - 1] > t) --i;
    const float fraction = std::clamp((t - edges[i - 1]) / (edges[i] - edges[i - 1]), 0.0f, 1.0f);
    return opticalDepth[i - 1] + (opticalDepth[i] - opticalDepth[i - 1]) * fraction;
}

/// What is covered in front of an emitter of unit normal n that the cone crosses at `crossing`, its own voxels taken back.
inline float depthInFront(const MarchSchedule& schedule, const MarchStep& step, const TapSize& size, const MarchScratch& scratch, OpacityAxes axes,
                          const Vec3& direction, const Vec3& normal, float cosine, float crossing, float delay)
{
    const int done = step.firstTap + step.taps;
    const Vec3 now = opticalDepthAt(schedule.edges, scratch.opticalDepth, done, crossing - kFrontTaps * size.width);
    const Vec3 before = opticalDepthAt(schedule.edges, scratch.opticalDepth, done, crossing - delay);
    const float edge = 1.0f / std::min(size.width / size.voxel, kLongestColumnVoxels), c = std::max(cosine, kLeastEmitterCosine);
    Vec3 own = (glm::abs(normal) + edge) / c;
    own = axes == OpacityAxes::directional ? glm::abs(direction) * own : Vec3(sumOf(own), 0.0f, 0.0f);
    return sumOf(now - glm::min(glm::max(now - before, Vec3(0.0f)), own));
}

/// Emission of one light's layers within one segment, weighted by the transmittance in front of the emitter.
template <class Recorder>
Vec3 slabEmission(const ConeWorld& world, int light, const ConeRay& ray, const Vec3& pWorld, const MarchSchedule& schedule, std::size_t index,
                  const TapSize& size, const MarchScratch& scratch, ConeCounts& counts, Recorder& recorder)
{
    const ConeSettings& settings = world.settings;
    const Lrsm& lrsm = world.lrsms[std::size_t(light)];
    if (lrsm.layers() == 0) return Vec3(0.0f);
    const LightSpacePoint at = projectToLight(lrsm.projection, pWorld);
    if (!at.valid) return Vec3(0.0f);

    const MarchStep& step = schedule.steps[index];
    const float voxelSize = world.opacity.base.grid.voxelSize;
    const float tap = footprintVoxels(step) * voxelSize, segment = (step.end - step.begin) * voxelSize;
    const float range = lrsm.projection.depthRange(), zc = at.depth * range;  // metres beyond depthNear
    const float window = (0.5f * segment + kKernelReachTaps * tap) / range;
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

        // The layer's depths (Eq. 10, 11), in metres, blurred by the footprint's own width.
        const float warpedMean = depth[0] / depth[2];
        const float warpedVariance = std::max(0.0f, depth[1] / depth[2] - warpedMean * warpedMean);
        const float scale = (bounds.depthMax - bounds.depthMin) * range;
        const float mean = bounds.depthMin * range + warpedMean * scale;
        const float sigma = std::sqrt(warpedVariance * scale * scale + 0.25f * tap * tap);
        const float e0 = zc - mean, h = 0.5f * rate * segment;
        if (std::abs(e0) - h > kNegligibleSigmas * sigma) continue;
        const float weight = world.phi((e0 + h) / sigma) - world.phi((e0 - h) / sigma);

        // Where its tangent plane is crossed, and what stands in front of that.
        const float length = glm::length(normal), cosine = nDotV / length, slack = kCrossingSlackTaps * step.tapWidth;
        const float crossing = std::clamp(step.middle - e0 / (rate * voxelSize), step.begin - slack, step.end + slack);
        const float delay = (settings.gather.emitterDelayTaps * size.width + settings.gather.emitterDelayVoxels * size.voxel) /
                            std::max(cosine, settings.gather.emitterSlantCap);
        const float front = depthInFront(schedule, step, size, scratch, world.opacity.axes, ray.direction, normal / length, cosine, crossing, delay);
        const float transmittance = transmittanceOf(front, settings);
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
/// floats: with a layer 160 footprints deep instead of fitted to its texels, what that leaves of sigma^2 is seen (the second).
inline constexpr float kMarchSlabMaxError = 5e-5f, kMarchSlabWideMaxError = 2e-3f;

template <class Sampler, class Recorder>
ConeResult marchSlab(const ConeWorld& world, const Sampler& sampler, const ConeRay& ray, const MarchSchedule& schedule, MarchScratch& scratch,
                     ConeCounts& counts, Recorder& recorder)
{
    const ConeSettings& settings = world.settings;
    const VoxelGrid& grid = world.opacity.base.grid;
    const VoxelBox box = outermostBox(world.opacity);
    const float exit = boxExit(ray.originVoxels, ray.direction, box.low, box.high);

    ConeResult result;
    Vec3 depth(0.0f);  // F so far
    scratch.opticalDepth.resize(schedule.edges.size());
    if (!scratch.opticalDepth.empty()) scratch.opticalDepth[0] = depth;
    bool wasOccupied = true;  // the first segments may touch what the receiver stands on
    ++counts.cones;
    for (std::size_t i = 0; i < schedule.steps.size(); ++i) {
        const MarchStep& step = schedule.steps[i];
        if (step.begin - kKernelReachTaps * step.tapWidth > exit) break;
        ++counts.steps;
        const Vec3 offset = ray.direction * step.middle;

        const float before = sumOf(depth);
        bool occupied = !step.readVoxels;
        for (int k = step.firstTap; k < step.firstTap + step.taps; ++k) {
            if (step.readVoxels) {
                ++counts.voxelTaps;
                forTapParts(sampler, ray.originVoxels + ray.direction * schedule.tapCentre(k), step.level, [&](const Vec3& tap) {
                    occupied = occupied || sumOf(tap) > 0.0f;
                    depth += coveredAlong(world.opacity, tap, ray.direction) * (schedule.edges[std::size_t(k) + 1] - schedule.edges[std::size_t(k)]);
                });
            }
            scratch.opticalDepth[std::size_t(k) + 1] = depth;
        }

        const Vec3 pWorld = ray.originWorld + offset * grid.voxelSize;
        if constexpr (Recorder::active) {
            const float covered = sumOf(depth) - before;
            recorder.step({&step, pWorld, covered / (step.end - step.begin), covered, transmittanceOf(sumOf(depth), settings)});
        }

        // Where neither this nor the last segment met a voxel there is no surface to emit.
        if (occupied || wasOccupied) {
            if constexpr (RecordsLookups<Recorder>) recorder.lookup(ConeSample{pWorld, 0.5f * step.diameter * grid.voxelSize, -ray.direction});
            const TapSize size = tapSizeAt(world.opacity, ray.originVoxels + offset, step.level, step.tapWidth);
            for (int light = 0; light < static_cast<int>(world.lrsms.size()); ++light)
                result.radiance += slabEmission(world, light, ray, pWorld, schedule, i, size, scratch, counts, recorder);
        }
        wasOccupied = occupied;

        // Done when the transmittance is spent for every emitter to come: what stands in front of it is at least F at `settled`.
        const Vec3 spent = opticalDepthAt(schedule.edges, scratch.opticalDepth, step.firstTap + step.taps, step.settled);
        if (transmittanceOf(sumOf(spent), settings) < settings.march.transmittanceCutoff) break;
    }
    result.opacity = 1.0f - transmittanceOf(sumOf(depth), settings);
    return result;
}

}  // namespace lrsm
