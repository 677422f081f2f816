#pragma once

#include <string>
#include <vector>

namespace lrsm {

/// All bytes of a regular file. InputError "PATH: why" for an empty path, a missing file, a folder, a device; MachineError when
/// reading breaks off.
std::vector<unsigned char> readFile(const std::string& path);

}  // namespace lrsm
