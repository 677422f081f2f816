#include "core/base/parallel.h"

#include "core/base/float_state.h"
#include "core/base/threads.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace lrsm {

namespace {

#ifdef __SANITIZE_THREAD__
/// The thread sanitizer does not see how oneTBB, which is not built with it, hands work over, and would call all of it racy. Plain threads
/// stand in for it, so that what is reported is ours.
template <class Chunk>
void runChunks(std::size_t chunks, const Chunk& chunk)
{
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failureMutex;
    const auto work = [&] {
        try {
            for (std::size_t c; (c = next.fetch_add(1, std::memory_order_relaxed)) < chunks;) chunk(c);
        } catch (...) {
            const std::scoped_lock lock(failureMutex);
            failure = std::current_exception();
        }
    };
    std::vector<std::thread> threads(std::min(chunks, tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
    for (std::thread& thread : threads) thread = std::thread(work);
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}
#else
template <class Chunk>
void runChunks(std::size_t chunks, const Chunk& chunk)
{
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t c = range.begin(); c != range.end(); ++c) chunk(c);
        },
        tbb::simple_partitioner());
}
#endif

}  // namespace

void parallelFor(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
{
    const std::size_t chunkSize = std::max<std::size_t>(grain, 1);
    const std::size_t chunks = (count + chunkSize - 1) / chunkSize;
    runChunks(chunks, [&](std::size_t c) {
        const FloatState state;  // a worker keeps whatever its thread was made with
        body(c * chunkSize, std::min(count, (c + 1) * chunkSize));
    });
}

ThreadLimit::ThreadLimit(int threads)
{
    if (threads > 0) control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism, std::size_t(grantedThreads(threads)));
}

ThreadLimit::~ThreadLimit()
{
    delete static_cast<tbb::global_control*>(control_);
}

}  // namespace lrsm
