#include "apps/common/interrupts.h"

#include <csignal>

namespace lrsm {

namespace {

// The one thing a signal handler may touch.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

CatchInterrupts::CatchInterrupts()
{
    interrupted = false;
    for (const int number : {SIGINT, SIGTERM})
        std::signal(number, [](int received) {
            interrupted = true;
            std::signal(received, SIG_DFL);
        });
}

CatchInterrupts::~CatchInterrupts()
{
    for (const int number : {SIGINT, SIGTERM}) std::signal(number, SIG_DFL);
}

const std::atomic<bool>& CatchInterrupts::asked() const
{
    return interrupted;
}

}  // namespace lrsm
