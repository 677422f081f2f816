#pragma once

#include "voxel/opacity_pyramid.h"

namespace lrsm {

/// Fill level 1.. of a pyramid whose base, settings, levelOffset and (zeroed) texels are in place. Parallel over slices; each texel is
/// written once and depends on the level below alone.
void fillLevelsFromBits(OpacityPyramid& pyramid);  ///< level 1; directional: levels 1, 2 and 3
void fillLevelFromBelow(OpacityPyramid& pyramid, int level);

}  // namespace lrsm
