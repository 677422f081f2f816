#pragma once

#include "core/scene/scene.h"

#include <array>
#include <string>
#include <vector>

/// A glTF file as it was parsed: local spaces, a node tree, animations, encoded images. `poseAsset` (pose_asset.h) makes a Scene of it.
/// Everything here has been validated: indices are in range, parallel streams have equal lengths, the tree has no loop.
namespace lrsm::gltf {

using DVec3 = glm::dvec3;
using DMat4 = glm::dmat4;

struct Node {
    std::string name;
    bool hasMatrix = false;  ///< `matrix` instead of the three properties
    DMat4 matrix{1.0};
    DVec3 translation{0.0};
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};  ///< unit quaternion x, y, z, w
    DVec3 scale{1.0};
    int parent = -1;
    std::vector<int> children;
    int mesh = -1, skin = -1, camera = -1, light = -1;
    std::vector<float> weights;    ///< of morph targets; empty: the mesh's
    std::vector<DMat4> instances;  ///< EXT_mesh_gpu_instancing: its mesh once for each, node from instance; empty: once
};

/// Displacements of one morph target; an absent stream is empty.
struct MorphTarget {
    std::vector<Vec3> positions, normals;
};

/// Up to four joints a vertex and set, and their weights.
struct Influences {
    std::vector<std::array<std::uint32_t, 4>> joints;
    std::vector<Vec4> weights;
};

struct Primitive {
    int material = 0;  ///< index into Asset::materials
    std::vector<Vec3> positions, normals;
    std::vector<Vec4> tangents;
    std::vector<Vec2> uv0, uv1;  ///< the two sets that its material's textures use
    std::vector<Vec4> colors;
    std::vector<Influences> influences;  ///< sets 0 and 1, as far as the file has them
    std::vector<MorphTarget> targets;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<float> weights;
};

struct Skin {
    std::vector<int> joints;         ///< node indices
    std::vector<DMat4> inverseBind;  ///< one a joint
};

/// Which of the file's sets of texture coordinates stand in for a mesh's first and second; -1: none.
using UvSets = std::array<int, 2>;

enum class Interpolation { step, linear, cubicSpline };
enum class Property { translation, rotation, scale, weights };

struct Channel {
    int node = -1;
    Property property = Property::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times;   ///< not decreasing, at least one; where two are equal the value jumps
    int width = 3;              ///< floats a value
    std::vector<float> values;  ///< width a time; cubicSpline: in-tangent, value, out-tangent
};

struct Animation {
    std::string name;
    std::vector<Channel> channels;
};

/// An encoded image (PNG, JPEG ...), or the reason why it could not be read: that matters only if a triangle uses it.
struct EncodedImage {
    std::string name;
    std::vector<unsigned char> bytes;
    std::string problem;
};

/// Position, direction and up come from the node.
struct LocalLight {
    Light light;
    bool point = false;
};

struct Asset {
    std::string file;  ///< as the user gave it, for messages
    std::vector<Node> nodes;
    std::vector<int> parentsFirst;  ///< all nodes, each after its parent
    std::vector<int> sceneNodes;    ///< nodes of the scene to show, each after its parent
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<Animation> animations;
    std::vector<Material> materials;                 ///< the last one is glTF's default material
    std::vector<UvSets> materialUvSets;              ///< one a material
    std::vector<std::shared_ptr<Texture>> textures;  ///< images and mips by openGltf; empty until then
    std::vector<int> textureImage;                   ///< index into `images` for each texture, -1: none
    std::vector<EncodedImage> images;
    std::vector<LocalLight> lights;
    std::vector<Camera> cameras;
    std::vector<std::string> notes;
};

/// The whole file, validated and parsed; images still encoded. Throws InputError.
Asset readAsset(const std::string& path);

}  // namespace lrsm::gltf
