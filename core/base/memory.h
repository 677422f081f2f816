#pragma once

#include <cstddef>
#include <string>

namespace lrsm {

/// Bytes that this process can still be given: what the system calls available, or what its control group leaves of its limit, whichever is less.
/// The largest size_t where neither says.
std::size_t availableMemory();

/// MachineError "place: needs ..., and the machine has ...; remedy" where `bytes` cannot be had. To be asked before a large allocation: an
/// overcommitting system grants any, and kills the program later. Less than 64 MB is granted unasked.
void requireMemory(std::size_t bytes, const std::string& place, const std::string& remedy);

}  // namespace lrsm
