#pragma once

#include "conetrace/frame/cones.h"
#include "conetrace/frame/lobe.h"
#include "conetrace/frame/schedule.h"
#include "core/scene/requirements.h"

#include <vector>

namespace lrsm {

/// Directions and schedules of one frame's cones.
struct GatherPlan {
    ConeSet cones;
    std::vector<MarchSchedule> ringSchedules;      ///< one a ring
    SpecularLobes lobes;                           ///< where specular cones look
    std::vector<MarchSchedule> specularSchedules;  ///< by roughness class; one when the aperture is fixed, none without specular cones

    /// The schedule of the specular cone for this roughness (clamped to [0, 1]; NaN counts as 0).
    const MarchSchedule& specularSchedule(float roughness) const;
};

/// Of the whole grid, in voxels: how far cones reach.
inline float gridDiagonal(int gridResolution)
{
    constexpr float kCubeDiagonal = 1.7320508f;
    return kCubeDiagonal * static_cast<float>(gridResolution);
}

/// Cones reach through the whole grid, `gridResolution` voxels along an edge (of cascades: through all of them, in the finest's voxels).
GatherPlan planGather(const ConeSettings& settings, const Requirements& needs, int gridResolution);

}  // namespace lrsm
