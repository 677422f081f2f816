#pragma once

#include "apps/capture/npy.h"

#include <string>
#include <vector>

/// numpy.savez and numpy.savez_compressed: a zip of .npy files, read by libzip.
namespace lrsm {

/// Names of the arrays in it, as numpy.load(path).files has them, in the file's order. InputError "PATH: why" for what is no zip.
std::vector<std::string> namesInNpz(const std::string& path);

/// The array of that name. InputError "PATH, NAME: why".
NpyArray readNpz(const std::string& path, const std::string& name);

}  // namespace lrsm
