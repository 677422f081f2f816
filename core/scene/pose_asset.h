#pragma once

#include "core/scene/animate.h"

namespace lrsm::gltf {

/// The asset's scene in world space: morphed, skinned and transformed meshes, lights and cameras; the second and last step of
/// loading. Textures' images stay empty. Throws InputError where a transform gives no finite world position or no direction.
///
/// glTF's rules: a skinned mesh ignores its own node's transform; a node of negative determinant turns its triangles over; normals
/// go with the inverse transpose; a primitive without normals gets flat ones, its vertices split.
Scene poseAsset(const Asset& asset, const Pose& pose);

}  // namespace lrsm::gltf
