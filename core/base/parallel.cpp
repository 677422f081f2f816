#include "core/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace lrsm {

void parallelFor(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body)
{
    const std::size_t chunkSize = std::max<std::size_t>(grain, 1);
    const std::size_t chunks = (count + chunkSize - 1) / chunkSize;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t c = range.begin(); c != range.end(); ++c)
                body(c * chunkSize, std::min(count, (c + 1) * chunkSize));
        },
        tbb::simple_partitioner());
}

ThreadLimit::ThreadLimit(int threads)
{
    if (threads > 0)
        control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
}

ThreadLimit::~ThreadLimit()
{
    delete static_cast<tbb::global_control*>(control_);
}

}  // namespace lrsm
