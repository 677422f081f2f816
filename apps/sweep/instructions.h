#pragma once

#include <cstdint>
#include <optional>

namespace lrsm {

/// Instructions that the process has retired in user mode, where the kernel counts them (perf_event_open; most containers refuse it). Threads count that are
/// started after the constructor by the thread that ran it, or by those that it started: make it before the first parallel work.
class InstructionCounter {
  public:
    InstructionCounter();
    ~InstructionCounter();
    InstructionCounter(const InstructionCounter&) = delete;
    InstructionCounter& operator=(const InstructionCounter&) = delete;

    /// Since the constructor; nothing where they are not counted.
    std::optional<std::uint64_t> count() const;

  private:
    int descriptor_ = -1;
};

}  // namespace lrsm
