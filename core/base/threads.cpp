#include "core/base/threads.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace lrsm {

int grantedThreads(int wanted)
{
    const int all = wanted > 0 ? wanted : std::max(1, int(std::thread::hardware_concurrency()));
    // All at once: each waits until the last is there.
    std::mutex mutex;
    std::condition_variable released;
    bool done = false;
    std::vector<std::thread> threads;
    try {
        while (int(threads.size()) + 1 < all)
            threads.emplace_back([&] {
                std::unique_lock lock(mutex);
                released.wait(lock, [&] { return done; });
            });
    } catch (const std::system_error&) {
        // So many, then.
    }
    {
        const std::scoped_lock lock(mutex);
        done = true;
    }
    released.notify_all();
    for (std::thread& thread : threads) thread.join();
    return int(threads.size()) + 1;
}

}  // namespace lrsm
