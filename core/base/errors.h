#pragma once

#include <stdexcept>
#include <string>

namespace lrsm {

/// Bad usage or bad input. `what()` is the one line a user reads: "place: why; what to do". Exit code 2.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
    InputError(const std::string& place, const std::string& why) : std::runtime_error(place + ": " + why) {}
};

/// The machine failed us: disk full, no permission, memory. Exit code 3.
class MachineError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
    MachineError(const std::string& place, const std::string& why) : std::runtime_error(place + ": " + why) {}
};

}  // namespace lrsm
