#pragma once

#include <cfenv>

namespace lrsm {

/// While it lives, this thread computes in IEEE's default manner: round to nearest even, denormals kept, nothing trapped. Golden bits must not
/// depend on what the host program, a library, or start-up code linked by -Ofast left in the control word. Restored at the end.
class FloatState {
  public:
    FloatState()
    {
        std::fegetenv(&saved_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~FloatState() { std::fesetenv(&saved_); }
    FloatState(const FloatState&) = delete;
    FloatState& operator=(const FloatState&) = delete;

  private:
    std::fenv_t saved_;
};

}  // namespace lrsm
