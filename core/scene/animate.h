#pragma once

#include "core/scene/gltf_asset.h"

#include <optional>
#include <span>

/// Node transforms and morph weights of a glTF asset at a moment (glTF 2.0, section 3.11 and appendix C).
namespace lrsm::gltf {

/// As glTF nodes and instances have it: scaled, then turned, then moved.
struct LocalTransform {
    DVec3 translation{0.0}, scale{1.0};
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};  ///< unit quaternion
};
DMat4 compose(const LocalTransform& local);

struct Pose {
    std::vector<DMat4> worldFromNode;         ///< one a node
    std::vector<glm::dmat3> turned;           ///< one a node: the same without places and sizes, for what has a direction alone; orthonormal
    std::vector<std::vector<float>> weights;  ///< morph weights, one list a node; empty where the node has no targets
    /// To the bit, so that -0 is not 0.
    bool sameAs(const Pose& other) const;
};

/// `animation` is an index, or -1 for the nodes as the file has them. `time` in seconds. `placement`, where there is one, goes over the roots: where a whole
/// file is put in a world. `origin`, in metres, is subtracted from the roots' places after it, so that everything below comes out relative to it before
/// anything is rounded to float.
Pose poseNodes(const Asset& asset, int animation, float time, const DVec3& origin = DVec3(0.0), const std::optional<DMat4>& placement = {});

/// A channel's value at `time`, clamped to its first and last keyframe: channel.width numbers into `value`. STEP holds, LINEAR
/// interpolates (rotations along the shorter great arc), CUBICSPLINE is Hermite's; a rotation comes out with unit length.
void sampleChannel(const Channel& channel, float time, std::span<double> value);

/// Spherical interpolation between unit quaternions (x, y, z, w), t in [0, 1], along the shorter arc.
glm::dvec4 slerp(const glm::dvec4& from, glm::dvec4 to, double t);

}  // namespace lrsm::gltf
