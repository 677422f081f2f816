#pragma once

#include "core/settings/settings.h"

#include <vector>

/// Where a cone takes its samples. Distances along the cone depend on its aperture alone, so a frame makes one schedule per ring
/// and no pixel computes a logarithm for its mip levels. All lengths are in base voxels.
namespace lrsm {

struct MarchStep {
    float middle = 0.0f;             ///< distance of the sample from the cone's apex
    float begin = 0.0f, end = 0.0f;  ///< of the segment it stands for
    float diameter = 0.0f;           ///< of the sphere inscribed in the cone there
    float level = 0.0f;              ///< voxel mip level, bias included, >= 0
    float tapWidth = 0.0f;           ///< edge of a voxel at that level: 2^level
    bool readVoxels = true;          ///< false in the first segment of `slab`: it starts inside the receiver's own voxels
    float settled = 0.0f;            ///< `slab`: no later segment takes its transmittance from nearer than this: what is spent here is spent for good
};

struct MarchSchedule {
    float tanHalf = 0.0f;
    std::vector<MarchStep> steps;
};

/// `paper`: sphere centres from startVoxels on, each a step (step * diameter) apart; diameter = max(minDiameter, 2 t tanHalf);
/// level = max(0, log2(diameter) + voxelLevelBias).
/// `slab`: contiguous segments sampled in their middle; the first is [0, startVoxels] and reads no voxels.
/// A later emitter's transmittance is taken up to (emitterDelayTaps tapWidth + emitterDelayVoxels) / emitterSlantCap before it: `settled` is the least
/// such distance of all segments to come.
/// Ends at `reachVoxels` (the grid's diagonal) or maxSteps; InputError where a step is too short for float32 to be taken.
/// Levels (and widths, relatively) are within kVoxelLevelMaxError of what the diameters say;
/// places and diameters within kSchedulePlaceMaxError, times the number of steps, of the recurrence in exact arithmetic, relatively.
inline constexpr float kVoxelLevelMaxError = 6e-7f, kSchedulePlaceMaxError = 1.2e-7f;
MarchSchedule makeSchedule(const ConeSettings& settings, float tanHalf, float reachVoxels);

}  // namespace lrsm
