#pragma once

#include "conetrace/frame/gbuffer.h"
#include "core/settings/settings.h"
#include "voxel/opacity_pyramid.h"

namespace lrsm {

/// One surface, ready for cones.
struct Receiver {
    Vec3 position{0.0f};
    Vec3 geometricNormal{0.0f}, normal{0.0f};
    Vec3 originVoxels{0.0f}, originWorld{0.0f};  ///< the cones' apex: off the surface by normalOffsetVoxels
    int rotation = 0;                            ///< of the cone set, 0 .. kRotations - 1
};
Receiver receiverAt(const GBuffer& gbuffer, const VoxelGrid& grid, const ConeSettings& settings, int x, int y);

/// Which cascade a pixel's cones count in (cascadeOfReceiver): near a border the rotations differ, and the 4x4 filter blends them.
int cascadeOfPixel(const GBuffer& gbuffer, const OpacityPyramid& finest, const ConeSettings& settings, int x, int y);

}  // namespace lrsm
