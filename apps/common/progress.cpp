#include "apps/common/progress.h"

#include <unistd.h>
#include <algorithm>
#include <cstdio>

namespace lrsm {

Progress::Progress(bool quiet) : active_(!quiet && ::isatty(STDERR_FILENO)) {}

Progress::~Progress()
{
    clear();
}

void Progress::show(const std::string& what, double fraction)
{
    if (!active_) return;
    const auto now = std::chrono::steady_clock::now();
    if (drawn_ && what == lastWhat_ && now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    lastWhat_ = what;
    drawn_ = true;

    constexpr int kWidth = 30;
    const int filled = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * kWidth);
    std::string bar(static_cast<std::size_t>(filled), '#');
    bar.resize(kWidth, '.');
    std::fprintf(stderr, "\r\033[K%s [%s] %3d %%", what.c_str(), bar.c_str(), static_cast<int>(100.0 * std::clamp(fraction, 0.0, 1.0)));
    std::fflush(stderr);
}

void Progress::clear()
{
    if (drawn_) std::fputs("\r\033[K", stderr);
    drawn_ = false;
}

}  // namespace lrsm
