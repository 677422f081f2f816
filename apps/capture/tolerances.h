#pragma once

#include "apps/capture/buffer.h"

/// Tier B: how far another machine's pass may be from ours on the same inputs, and why. All of them are here.
namespace lrsm::tolerances {

Tolerance given();   ///< scene and tables: a candidate need not have them
Tolerance voxels();  ///< of the bits
Tolerance voxelMip(bool unorm);
Tolerance mapRadiance(int resolution);  ///< of an RSM
Tolerance mapNormal(int resolution);
Tolerance mapDepth(int resolution);
Tolerance layerHalf(bool half);
Tolerance layerDepth(bool unorm, int level);
Tolerance length(double sceneDiagonal, int height);  ///< positions and depths of the G-buffer
Tolerance surfaceNormal(int height);
Tolerance surface();  ///< albedo, roughness of the G-buffer
Tolerance objectId();
Tolerance direct();
Tolerance cones();
Tolerance coneOpacity();
Tolerance filter();
Tolerance product();       ///< composite: a few multiplications
Tolerance specularPart();  ///< composite: a table besides

/// Sets the floor of a relative tolerance: a twentieth of the mean magnitude of the elements that are not 0.
void setFloor(Buffer& buffer);

}  // namespace lrsm::tolerances
