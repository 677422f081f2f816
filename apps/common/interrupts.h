#pragma once

#include <atomic>

namespace lrsm {

/// What a shell reports for Ctrl-C.
inline constexpr int kInterruptedCode = 130;

/// Ctrl-C and SIGTERM ask for a stop while this lives; a second one ends the program at once. One at a time.
class CatchInterrupts {
  public:
    CatchInterrupts();
    ~CatchInterrupts();
    CatchInterrupts(const CatchInterrupts&) = delete;
    CatchInterrupts& operator=(const CatchInterrupts&) = delete;

    const std::atomic<bool>& asked() const;
};

}  // namespace lrsm
