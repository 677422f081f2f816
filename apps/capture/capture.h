#pragma once

#include "apps/capture/buffer.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"
#include "core/settings/settings.h"
#include "lrsm/layers.h"
#include "voxel/bit_grid.h"

#include <string>
#include <vector>

/// One frame, pass by pass, as files: docs/capture.md is the format's description, docs/capture.schema.json the manifest's schema.
namespace lrsm {

inline constexpr const char* kCaptureFormat = "lrsm capture";
inline constexpr int kCaptureFormatVersion = 1;
inline constexpr const char* kManifestFile = "manifest.json";

/// What the capture knows of a light besides its buffers.
struct CapturedLight {
    Light light;
    LightProjection projection;
    std::vector<LayerRange> partition;       ///< all ranges asked for (partition() of layers.h)
    std::vector<int> stored;                 ///< of each: its layer in the LRSM, -1 where it was dropped as empty
    std::vector<std::uint64_t> validTexels;  ///< of each layer stored

    /// Of the layers stored: Lrsm::ranges.
    std::vector<LayerRange> storedRanges() const;
};

struct CapturedPass {
    std::string name;                 ///< "voxelize", "voxel mips", "rsm 0", "lrsm 0", "gbuffer", "direct", "cones", "filter", "smooth", "composite"
    std::vector<std::string> inputs;  ///< passes it reads; "scene" and "tables" among them
    std::string sha256;               ///< of the whole output, the one that frame.json has
};

/// A change of a golden capture that somebody stood up for.
struct Blessing {
    std::string reason, version;
    std::vector<std::string> buffers;  ///< whose bytes changed
};

/// All of one frame, in memory. What a manifest says beyond this is derived from it (manifest.h).
struct Capture {
    std::string version;               ///< of the program
    std::string sceneName, sceneHash;  ///< hashScene
    Aabb sceneBounds, sceneReach;      ///< Scene::bounds, Scene::reach
    glm::dvec3 origin{0.0};            ///< Scene::origin: all places count from it
    float preExposure = 1.0f;          ///< preExposureOf the scene: what the radiance of RSMs and LRSMs is multiplied by
    bool sceneComplete = false;        ///< the scene's buffers are all of it: it has no textures
    Settings settings;
    Requirements needs;
    int width = 0, height = 0;
    Camera camera;
    VoxelGrid grid;
    std::vector<CapturedLight> lights;
    std::vector<Material> materials;   ///< texture references point into a list that is not stored
    std::vector<CapturedPass> passes;  ///< in the order of the data flow
    std::vector<Buffer> buffers;       ///< in the order of the passes; some may be left out
    std::vector<Blessing> history;

    /// nullptr when there is none of this name.
    const Buffer* find(const std::string& name) const;
    /// InputError when there is none.
    const Buffer& at(const std::string& name) const;
};

}  // namespace lrsm
