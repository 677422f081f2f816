#pragma once

#include "lrsm/depth_map.h"

namespace lrsm {

/// Shadows by comparison with a light's depth map. A texel's depth is that of its centre, so it is compared with the depth that the receiver's own plane has
/// there (receiver-plane depth bias: Isidoro, "Shadow Mapping: GPU-based Tips and Techniques", GDC 2006): no convex surface shadows itself, at any angle,
/// since none of it lies in front of its planes. Where surfaces meet in a corner, one does lie in front of the other's plane within a texel: the bias is for
/// them.
struct ShadowReceiver {
    Vec3 position{0.0f};         ///< world
    Vec3 geometricNormal{0.0f};  ///< unit, faces the light
};

/// V by the texel that p is in: 0 where the surface there is nearer to the light than the receiver's plane by more than the bias, else 1. Also 1 outside the
/// map, where it is empty, and where the light meets the plane at a cosine below kGrazingCosine.
/// The bias is texel size * (biasTexels * (min(slope, kMaxBiasSlope) + kFlatBias) + kSnappingTexels * slope), slope being the tangent of the angle between
/// normal and light, and a few roundings of depth and distance.
float shadowFromMap(const DepthMapView& map, const ShadowReceiver& receiver, float biasTexels);

/// Percentage-closer filtering (Reeves et al., SIGGRAPH 1987): the mean of these comparisons over a square `widthTexels` wide about p. 1 is what a GPU's
/// comparison sampler does, bilinear between four texels.
float shadowFromMapFiltered(const DepthMapView& map, const ShadowReceiver& receiver, float biasTexels, float widthTexels);

inline constexpr float kFlatBias = 0.1f;
inline constexpr float kMaxBiasSlope = 16.0f;           ///< light at 3.6 degrees to the plane: more would leak for metres
inline constexpr float kSnappingTexels = 1.0f / 64.0f;  ///< four times what snapping vertices to 1/256 texel moves a map's surface, on its diagonal
inline constexpr float kGrazingCosine = 1e-3f;          ///< light at 0.06 degrees to the plane: a thousandth of what falls straight on it

}  // namespace lrsm
