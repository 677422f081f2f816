#pragma once

#include "core/base/rng.h"

#include <cstdint>

/// What a random draw is for: the last word of Philox's counter, which keeps the streams of one pixel or tile apart. Paths have theirs in its high byte.
namespace lrsm {

enum class Purpose : std::uint32_t {
    // of a pixel
    diffuseDirection = 0,
    lobeDirection = 1,
    coneDirection = 2,
    diffusePool = 3,
    lobePool = 4,
    lobeSubset = 5,
    diffusePath = 16,
    lobePath = 17,
    conePath = 18,
    // of a tile
    diffusePoints = 32,
    lobePoints = 33,
    furtherDiffusePoints = 34,
    furtherLobePoints = 35,
    // of the pilot
    pilotDirection = 64,
    pilotFurther = 65,
    pilotPoints = 66,
    pilotChoice = 67
};

}  // namespace lrsm
