#pragma once

#include "core/scene/scene.h"

#include <string>
#include <vector>

namespace lrsm {

/// SHA-256 (64 hexadecimal digits) of everything in the scene that can change a picture: geometry, materials, decoded textures, lights,
/// cameras. Names and notes do not count, so a renamed file is the same scene.
std::string hashScene(const Scene& scene);

/// The same part by part, but for cameras and textures: what two moments of one scene have in common. Equal keys, equal to the bit.
struct SceneKeys {
    std::vector<std::string> meshes, lights;  ///< one each
    std::string materials;                    ///< of all; a texture counts by its index
    std::string boxes;                        ///< bounds and reach
};
SceneKeys keysOf(const Scene& scene);

}  // namespace lrsm
