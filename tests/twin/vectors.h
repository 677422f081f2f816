#pragma once

#include "tests/twin/gl.h"

/// The equations one by one on OpenGL, on inputs that `lrsm validate --vectors` wrote (docs/vectors.md).
namespace lrsm::twin {

/// Reads `vectors`/vectors.json and the inputs that it names, leaves NAME.npy in `results`. Returns the sets that no shader has.
std::vector<std::string> runVectors(Programs& programs, const std::string& vectors, const std::string& results);

}  // namespace lrsm::twin
