#pragma once

#include "apps/capture/buffer.h"

/// Tier B: how far another machine's pass may be from ours on the same inputs, and why. All of them are here.
namespace lrsm::tolerances {

extern const Tolerance kGiven;   ///< scene and tables: a candidate need not have them
extern const Tolerance kVoxels;  ///< of the bits
Tolerance voxelMip(bool unorm);
Tolerance mapRadiance(int resolution);  ///< of an RSM
Tolerance mapNormal(int resolution);
Tolerance mapDepth(int resolution);
Tolerance layerHalf(bool half);
Tolerance layerDepth(bool unorm, int level);
Tolerance length(double sceneDiagonal, int height);  ///< positions and depths of the G-buffer
Tolerance surfaceNormal(int height);
extern const Tolerance kSurface;  ///< albedo, roughness of the G-buffer
extern const Tolerance kObjectId;
extern const Tolerance kDirect;
extern const Tolerance kCones;
extern const Tolerance kConeOpacity;
extern const Tolerance kFilter;
extern const Tolerance kVoxelSurface;    ///< means over a voxel's fragments
extern const Tolerance kInjected;        ///< radiance of a voxel
extern const Tolerance kInjectedNormal;  ///< of what emits in it
extern const Tolerance kClusters;        ///< indices and keys of clusters
extern const Tolerance kClusterAxes;
extern const Tolerance kPlaces;        ///< of caches
extern const Tolerance kFolded;        ///< irradiance of caches
extern const Tolerance kCached;        ///< what pixels take from caches
extern const Tolerance kPoints;        ///< of proxies and virtual lights
extern const Tolerance kCellSums;      ///< of the proxies in a cell
extern const Tolerance kLists;         ///< of cells, and what is counted of their rays
extern const Tolerance kMapDepths;     ///< of imperfect maps
extern const Tolerance kListed;        ///< what pixels take from cells or virtual lights
extern const Tolerance kProduct;       ///< composite: a few multiplications
extern const Tolerance kSpecularPart;  ///< composite: a table besides

/// Sets the floor of a relative tolerance: a twentieth of the mean magnitude of the elements that are not 0.
void setFloor(Buffer& buffer);

}  // namespace lrsm::tolerances
