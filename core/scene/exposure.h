#pragma once

#include "core/scene/scene.h"

namespace lrsm {

/// What the radiance of light maps is multiplied by before it is stored in half, and divided by where cones have gathered it: a power of two, so that no bit
/// of a mantissa changes. 1 where the brightest light lies in the ordinary range; else what brings it to [1, 2) from above, or to the range's lower end from
/// below, which leaves room for surfaces near the light. A light counts by its irradiance, W/m^2 per channel; a local one at a distance as long as the part of
/// the scene that the maps are fitted to, or as it is from there.
float preExposureOf(const Scene& scene);
inline constexpr double kOrdinaryIrradianceMin = 0x1p-6, kOrdinaryIrradianceMax = 0x1p8;

}  // namespace lrsm
