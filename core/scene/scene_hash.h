#pragma once

#include "core/scene/scene.h"

#include <string>

namespace lrsm {

/// SHA-256 (64 hexadecimal digits) of everything in the scene that can change a picture: geometry, materials, decoded textures, lights,
/// cameras. Names and notes do not count, so a renamed file is the same scene.
std::string hashScene(const Scene& scene);

}  // namespace lrsm
