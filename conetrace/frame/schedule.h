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
    float level = 0.0f;              ///< voxel mip level, bias included, >= 0; whole in `slab`
    float tapWidth = 0.0f;           ///< edge of a voxel at that level: 2^level
    bool readVoxels = true;          ///< false in the first segment of `slab`: it starts inside the receiver's own voxels
    int taps = 1;                    ///< `slab`: voxel lookups, each in the middle of a like share of the segment, a tapWidth long
    int firstTap = 0;                ///< `slab`: index of the first of them along the cone
    float settled = 0.0f;            ///< `slab`: neither this nor a later segment asks for the transmittance nearer to the apex than here
};

struct MarchSchedule {
    float tanHalf = 0.0f;
    std::vector<MarchStep> steps;
    std::vector<float> edges;  ///< `slab`: tap k stands for [edges[k], edges[k + 1]]; optical depth is linear between
    float tapCentre(int tap) const { return 0.5f * (edges[std::size_t(tap)] + edges[std::size_t(tap) + 1]); }
};

/// `paper`: sphere centres from startVoxels on, each a step (step * diameter) apart; diameter = max(minDiameter, 2 t tanHalf);
/// level = max(0, log2(diameter) + voxelLevelBias).
/// `slab`: contiguous segments; the first is [0, startVoxels] and reads no voxels. Levels are whole: floor(log2(diameter at the begin) + voxelLevelBias). A
/// segment is as many whole tap widths long as come nearest to step * diameter: lookups are tents of one width, which one width apart add up to one, so a
/// wall counts once wherever it stands.
/// An emitter's transmittance is taken up to kCrossingSlackTaps tapWidth + (emitterDelayTaps tapWidth + emitterDelayVoxels) / emitterSlantCap before its
/// segment: `settled` is the least such distance of this and all segments to come.
/// Ends at `reachVoxels` (the grid's diagonal) or maxSteps; InputError where a step is too short for float32 to be taken.
/// Levels (and widths, relatively) are within kVoxelLevelMaxError of what the diameters say;
/// places and diameters within kSchedulePlaceMaxError, times the number of steps, of the recurrence in exact arithmetic, relatively.
inline constexpr float kCrossingSlackTaps = 1.0f;  ///< a surface's crossing is looked for as far outside the segment that sees it
inline constexpr float kVoxelLevelMaxError = 6e-7f, kSchedulePlaceMaxError = 1.2e-7f;
MarchSchedule makeSchedule(const ConeSettings& settings, float tanHalf, float reachVoxels);

}  // namespace lrsm
