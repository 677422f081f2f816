#pragma once

#include <cstddef>
#include <functional>

namespace lrsm {

/// Calls body(begin, end) over disjoint chunks of [0, count) of at most `grain` items, in parallel. Chunk bounds depend
/// on count and grain alone, never on the number of threads, so per-chunk results can be combined in chunk order.
void parallelFor(std::size_t count, std::size_t grain, const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Limits oneTBB to `threads` for the lifetime of the object (0: all the machine has).
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

  private:
    void* control_ = nullptr;
};

}  // namespace lrsm
