#pragma once

#include "core/scene/scene.h"

#include <memory>
#include <optional>
#include <string>

/// glTF 2.0 files (.gltf with its buffers and images, .glb) as a world-space Scene at one moment.
///
/// Read: triangles, strips and fans with their vertex streams; metallic-roughness materials with base colour, metallic-roughness and
/// normal textures (PNG, JPEG, WebP); node, skin and morph target animation; cameras; KHR_lights_punctual, KHR_texture_transform, KHR_mesh_quantization,
/// EXT_mesh_gpu_instancing, EXT_meshopt_compression, KHR_draco_mesh_compression; of KHR_materials_pbrSpecularGlossiness the diffuse part.
/// What is mended (gltf_repair.h), skipped or replaced is said in Scene::notes.
namespace lrsm {

struct LoadOptions {
    float time = 0.0f;               ///< seconds; clamped to each animation sampler's range
    int animation = 0;               ///< index; -1: none, the nodes as the file has them
    std::string camera = "0";        ///< name or index of the one that will look: the scene's origin is chosen for it
    std::optional<Camera> eye = {};  ///< one that is not in the file, in its place; world space
};

namespace gltf {
struct Asset;
struct Pose;
}  // namespace gltf
/// A file as it was read, to be posed at any moment: all of it but the pose, textures with their mips.
using GltfFile = std::shared_ptr<const gltf::Asset>;

/// Throws InputError "FILE: JSON path: why" for a file that is no valid glTF or that requires an extension unknown here. Textures are decoded only where a
/// triangle's material uses them.
GltfFile openGltf(const std::string& path);

/// What a file was posed to last, and how it stood: a moment at which it stands the same takes it from here.
struct PosedFile {
    std::shared_ptr<const gltf::Pose> pose;
    Scene scene;
};

/// The scene at a moment; equal, to the bit, however often and at what other times the file was posed before. Throws InputError where no triangle has an area.
/// A scene without lights or camera gets default ones (defaults.h). A scene far from 0 gets an origin (Scene::origin): it is subtracted in double, once. The
/// result does not depend on the number of threads.
/// `kept`, where given, is of this file alone; it changes no bit.
Scene poseGltf(const gltf::Asset& file, const LoadOptions& options, PosedFile* kept = nullptr);

/// The last keyframe of an animation, seconds; 0 where there is no such one.
double lengthOfAnimation(const gltf::Asset& file, int animation);

/// Both.
Scene loadGltf(const std::string& path, const LoadOptions& options);

/// A file put into a scene among other things: what of it is posed and where.
struct Placement {
    int animation = 0;         ///< as LoadOptions's
    glm::dvec3 position{0.0};  ///< of the file's 0, in the scene file's world, metres
    double yawDegrees = 0.0;   ///< about +Y, counter-clockwise seen from above
    double scale = 1.0;        ///< before turning and moving; above 0
};

/// Adds the file's meshes, materials and textures to `scene`, at `time`, counted from Scene::origin; returns the first of its materials, which end with
/// Scene::materials. Its lights and cameras stay out, and a note says so. `kept` and InputError
/// as poseGltf's.
std::size_t addPlaced(Scene& scene, const gltf::Asset& file, const Placement& placement, float time, PosedFile* kept = nullptr);

/// The camera of that name, else of that index ("0" the first). InputError lists the ones there are.
const Camera& findCamera(const Scene& scene, const std::string& nameOrIndex);

}  // namespace lrsm
