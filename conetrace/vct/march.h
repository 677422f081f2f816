#pragma once

#include "conetrace/frame/cone.h"
#include "conetrace/frame/schedule.h"
#include "core/base/elementary.h"
#include "voxel/radiance/sample_radiance.h"

/// One cone through radiance in voxels, front to back.
namespace lrsm {

/// What a march keeps to, whatever volume it looks into.
struct RadianceMarch {
    const VoxelGrid& grid;
    const MarchSettings& settings;
    StepOpacity opacity;  ///< of a texel over a step
    float preExposure;    ///< of the volume's radiance
};

/// Everything that a cone reads.
struct VctWorld {
    const RadianceVolume& volume;
    const VoxelGrid& grid;
    const ConeSettings& cones;
    const VctSettings& vct;
};

inline RadianceMarch marchOf(const VctWorld& world)
{
    return {.grid = world.grid, .settings = world.cones.march, .opacity = world.vct.opacity, .preExposure = world.volume.preExposure};
}

/// What --pixel shows of one step.
struct VctStep {
    const MarchStep* step = nullptr;
    Vec3 pWorld{0.0f};
    Vec4 sample{0.0f};           ///< premultiplied radiance (times the pre-exposure), opacity
    float spent = 0.0f;          ///< transmittance that this step takes
    float transmittance = 1.0f;  ///< in front of this step
};

/// Opacity of a step: a texel's, as it is or over the step's length (`step`: 1 - (1 - a)^(dt/D), D the texel's width). Error as kStepOpacityMaxError of
/// fastLog2 and fastExp2.
inline float opacityOver(float a, float lengthInTexels, StepOpacity opacity)
{
    if (opacity == StepOpacity::none || a <= 0.0f) return a;
    if (a >= 1.0f) return 1.0f;
    return 1.0f - fastExp2(lengthInTexels * fastLog2(1.0f - a));
}

/// T behind a step. `exponential` is Eq. 1's product; `linear` sums the opacities, T = max(0, 1 - sum a dt/D), so that a wall, whose texels' opacities sum to
/// 1 along any ray across it, is just opaque.
inline float transmittanceBehind(float transmittance, float a, float lengthInTexels, const RadianceMarch& march)
{
    if (march.settings.transmittance == TransmittanceModel::linear)
        return std::max(0.0f, transmittance - (march.opacity == StepOpacity::step ? a * lengthInTexels : a));
    return transmittance * (1.0f - opacityOver(a, lengthInTexels, march.opacity));
}

/// I = sum of dT rgb / a, dT what a step takes of the transmittance: rgb / a is the mean radiance of what it meets. In the scene's units.
/// Where all that the cone meets has one radiance, I is that times the opacity, within kVctMarchMaxError relatively.
inline constexpr float kVctMarchMaxError = 2e-6f;
template <class LookUp, class Recorder>
ConeResult marchRadiance(const RadianceMarch& march, const LookUp& lookUp, const ConeRay& ray, const MarchSchedule& schedule, ConeCounts& counts,
                         Recorder& recorder)
{
    const MarchSettings& settings = march.settings;
    const float exit = gridExit(ray.originVoxels, ray.direction, march.grid.resolution);

    ConeResult result;
    float transmittance = 1.0f;
    ++counts.cones;
    for (const MarchStep& step : schedule.steps) {
        if (step.middle - kBlendedReachTaps * step.tapWidth > exit) break;
        ++counts.steps;
        ++counts.voxelTaps;
        const Vec3 offset = ray.direction * step.middle + ray.receiverNormal * (settings.push * (0.5f * step.diameter));
        const Vec4 sample = lookUp(ray.originVoxels + offset, step.level);
        const float behind = sample.w > 0.0f ? transmittanceBehind(transmittance, sample.w, (step.end - step.begin) / step.tapWidth, march) : transmittance;
        if constexpr (requires { recorder.step(VctStep{}); })
            recorder.step(VctStep{&step, ray.originWorld + offset * march.grid.voxelSize, sample, transmittance - behind, transmittance});
        if (!(sample.w > 0.0f)) continue;
        result.radiance += Vec3(sample) * ((transmittance - behind) / sample.w);
        transmittance = behind;
        if (transmittance < settings.transmittanceCutoff) break;
    }
    result.radiance /= march.preExposure;
    result.opacity = 1.0f - transmittance;
    return result;
}

/// Through a RadianceVolume.
template <class Recorder>
ConeResult marchRadiance(const VctWorld& world, const ConeRay& ray, const MarchSchedule& schedule, ConeCounts& counts, Recorder& recorder)
{
    const RadianceLookup lookUp(world.volume, world.vct, world.cones.march.filterFraction, ray.direction);
    return marchRadiance(marchOf(world), lookUp, ray, schedule, counts, recorder);
}

}  // namespace lrsm
