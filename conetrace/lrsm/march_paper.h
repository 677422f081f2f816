#pragma once

#include "conetrace/lrsm/march.h"
#include "core/base/elementary.h"

/// Algorithm 1 and Eq. 1 as the paper prints them, with every open choice a setting.
namespace lrsm {

/// Opacity of a step of `lengthVoxels` through a medium that the voxels say is `density`: taken as it is, or as density per base voxel, so that a
/// wall of one voxel has optical depth densityK at every level and step. Absolute error <= kStepOpacityMaxError *
/// max(1, densityK lengthVoxels / 16): 1 - a is rounded to float.
inline constexpr float kStepOpacityMaxError = 1e-6f;
inline float stepOpacity(float density, float lengthVoxels, const ConeSettings& settings)
{
    const float a = std::min(density, 1.0f);
    if (settings.march.opacity == OpacityModel::none || a <= 0.0f) return a;
    if (a >= 1.0f) return 1.0f;
    return 1.0f - fastExp2(settings.march.densityK * lengthVoxels * fastLog2(1.0f - a));
}

/// Error of a cone against the printed sum in double: of its opacity, and of its radiance over the largest that the map holds. Float positions in a
/// steep V are most of it.
inline constexpr float kMarchPaperMaxError = 5e-5f;

template <class Sampler, class Recorder>
ConeResult marchPaper(const ConeWorld& world, const Sampler& sampler, const ConeRay& ray, const MarchSchedule& schedule, MarchScratch&, ConeCounts& counts,
                      Recorder& recorder)
{
    const ConeSettings& settings = world.settings;
    const VoxelGrid& grid = world.opacity.base.grid;
    const VoxelBox box = outermostBox(world.opacity);
    const float exit = boxExit(ray.originVoxels, ray.direction, box.low, box.high);

    ConeResult result;
    float transmittance = 1.0f;
    ++counts.cones;
    for (const MarchStep& step : schedule.steps) {
        if (step.middle - step.diameter > exit) break;
        ++counts.steps;

        // The sphere, pushed off the receiver's own plane.
        const float radius = 0.5f * step.diameter;
        const Vec3 offset = ray.direction * step.middle + ray.receiverNormal * (settings.march.push * radius);
        const Vec3 pVoxels = ray.originVoxels + offset;

        // Occlusion.
        ++counts.voxelTaps;
        const Vec3 tap = sampler(pVoxels, step.level);
        const float density = sumOf(coveredAlong(world.opacity, tap, ray.direction));
        const float alpha = stepOpacity(density, step.end - step.begin, settings);
        const Vec3 pWorld = ray.originWorld + offset * grid.voxelSize;
        if constexpr (Recorder::active) recorder.step({&step, pWorld, density, alpha, transmittance});
        if (alpha <= 0.0f) continue;

        // Outgoing radiance of the sample, all lights (Algorithm 1), and Eq. 1.
        const ConeSample sample{pWorld, radius * grid.voxelSize, settings.march.push == 0.0f ? -ray.direction : glm::normalize(ray.originWorld - pWorld)};
        if constexpr (RecordsLookups<Recorder>) recorder.lookup(sample);
        Vec3 outgoing(0.0f);
        for (std::size_t light = 0; light < world.lrsms.size(); ++light) {
            const Lrsm& lrsm = world.lrsms[light];
            if constexpr (RecordsLayers<Recorder>) {
                std::vector<LayerTerms> terms;
                outgoing += sampleLrsm(lrsm, sample, settings, world.phi, &terms);
                for (const LayerTerms& term : terms) recorder.layer(static_cast<int>(light), term, transmittance);
            } else {
                outgoing += sampleLrsm(lrsm, sample, settings, world.phi);
            }
            counts.lrsmSamples += static_cast<std::uint64_t>(lrsm.layers());
        }
        result.radiance += (transmittance * alpha) * outgoing;
        transmittance *= 1.0f - alpha;
        if (transmittance < settings.march.transmittanceCutoff) break;
    }
    result.opacity = 1.0f - transmittance;
    return result;
}

}  // namespace lrsm
