#pragma once

#include "conetrace/frame/tiles.h"
#include "core/base/math.h"

#include <cstddef>
#include <vector>

/// The pixels of a tile walk one cone together: all cones of a ring take the same steps, so a step's level, lengths and weights are the same for every pixel,
/// only apex and direction differ.
namespace lrsm {

inline constexpr int kBatchCones = kTile * kTile;              ///< cones that a batch holds at most
inline constexpr int kWidestLanes = 16;                        ///< of any instruction set
inline constexpr int kBatchRoom = kBatchCones + kWidestLanes;  ///< lists are written a vector at a time

/// Apices and axes; distances along a cone are in base voxels.
struct ConeBatch {
    int count = 0;
    alignas(64) float originVoxels[3][kBatchRoom];
    alignas(64) float originWorld[3][kBatchRoom];
    alignas(64) float direction[3][kBatchRoom];       ///< unit
    alignas(64) float receiverNormal[3][kBatchRoom];  ///< geometric, unit

    void setOrigin(int cone, const Vec3& voxels, const Vec3& world, const Vec3& normal)
    {
        for (int axis = 0; axis < 3; ++axis) {
            originVoxels[axis][cone] = voxels[axis];
            originWorld[axis][cone] = world[axis];
            receiverNormal[axis][cone] = normal[axis];
        }
    }
    void setDirection(int cone, const Vec3& unit)
    {
        for (int axis = 0; axis < 3; ++axis) direction[axis][cone] = unit[axis];
    }
};

/// Of each cone of a batch: I of Eq. 1, and 1 - transmittance at its end.
struct ConeBatchResult {
    alignas(64) float radiance[kBatchRoom][4];
    alignas(64) float opacity[kBatchRoom];
};

/// Where there are several cascades: what of a tap goes from one to the next, by cone, and of the lookups their factor, as forCascades has them.
struct CascadeTaps {
    alignas(64) float voxels[3][kBatchRoom];
    alignas(64) float left[kBatchRoom];
    alignas(64) float factor[kBatchRoom];
    alignas(64) float width[kBatchRoom], voxel[kBatchRoom];  // TapSize where a surface is asked for, by cone
};

/// What a march keeps of its cones from step to step, by cone, and its lists of those that a stage has left over. A stage writes a list, the next one
/// reads it: whatever share of the cones survives, all lanes are busy.
struct MarchBatchScratch {
    std::vector<float> opticalDepth;      ///< F by axis (isotropic: one value): [(row * channels + axis) * kBatchCones + cone]
    std::vector<std::int32_t> rowOfEdge;  ///< row that holds F at an edge of the schedule's taps
    int channels = 3;                     ///< 1 or 3
    float* depthAt(int edge, int axis) { return opticalDepth.data() + std::size_t(rowOfEdge[std::size_t(edge)] * channels + axis) * kBatchCones; }
    alignas(64) float exit[kBatchRoom];
    alignas(64) std::int32_t octant[kBatchRoom], alive[kBatchRoom], occupied[kBatchRoom], wasOccupied[kBatchRoom];
    // Cones whose tap may meet a voxel; their sample's place, in voxels, and what it holds along each axis: packed.
    alignas(64) std::int32_t mayHold[kBatchRoom];
    alignas(64) float lookupVoxels[3][kBatchRoom];
    alignas(64) float density[3][kBatchRoom];
    CascadeTaps cascadeTaps;
    // Cones that may meet an emitter: their sample's place, in the world.
    alignas(64) std::int32_t request[kBatchRoom];
    alignas(64) std::int32_t requestOctant[kBatchRoom];  // of its direction: bit k: component k is negative
    alignas(64) float requestWorld[3][kBatchRoom];
};

}  // namespace lrsm
