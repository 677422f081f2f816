#pragma once

#include "core/scene/scene.h"

/// What a pass may take for granted about scene, lights and camera, checked where it enters: each throws one InputError that names thing, value and
/// what is allowed. File readers check more, and name the file; these guard the passes themselves, whoever calls them.
namespace lrsm {

/// Metres. Beyond, products of coordinates leave float's range; a scene smaller than the least would lose its squares.
inline constexpr float kMaxCoordinate = 1e15f, kMinSceneExtent = 1e-12f;
/// Degrees of a spot's outer angle from its axis: wider, a perspective map has hardly a texel left for the middle.
inline constexpr float kMaxOuterConeDegrees = 89.0f;
/// Distance of the farthest point over the near plane: beyond, a float32 depth buffer cannot tell surfaces apart at all.
inline constexpr double kMaxDepthRatio = 1e7;

/// No extent at all is fine (an empty scene, a point).
void checkBounds(const Aabb& bounds);
void checkLight(const Light& light);
void checkCamera(const Camera& camera);
/// Factors of all materials: finite, metallic and roughness in [0, 1].
void checkMaterials(const Scene& scene);
/// Bounds, materials, lights, and that streams and indices fit together. Positions may be NaN (their triangles are dropped, and counted).
void checkScene(const Scene& scene);

}  // namespace lrsm
