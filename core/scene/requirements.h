#pragma once

#include "core/scene/scene.h"
#include "core/settings/settings.h"

#include <string>
#include <vector>

namespace lrsm {

/// What this scene needs: the mask that every pass obeys. Leaving out what is not needed changes no bit of the picture.
struct Requirements {
    bool specular = true;   ///< some material has a specular part: specular cones and channels
    bool alphaTest = true;  ///< some material has an alpha mask
    bool normalMaps = true;
    bool textures = true;
    bool vertexColors = true;
    std::vector<std::string> leftOut;  ///< "specular cones: no material has a specular part", ... for info and frame.json
};

/// With `force.everything` all masks are true and nothing is left out.
Requirements analyseRequirements(const Scene& scene, const ForceSettings& force);

}  // namespace lrsm
