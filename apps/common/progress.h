#pragma once

#include <chrono>
#include <string>

namespace lrsm {

/// One line on standard error that rewrites itself; silent unless that is a terminal.
class Progress {
  public:
    explicit Progress(bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// fraction in [0, 1] of `what`. At most ten lines a second are drawn.
    void show(const std::string& what, double fraction);
    void clear();

  private:
    bool active_;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point last_{};
    std::string lastWhat_;
};

}  // namespace lrsm
