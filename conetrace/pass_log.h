#pragma once

#include "conetrace/render.h"

#include <chrono>
#include <ctime>
#include <string>
#include <utility>

/// Runs a pass, and notes its time, the bytes of what it made, its hash, and whether a NaN or infinity is in it.
namespace lrsm {

struct PassSize {
    std::size_t bytes = 0, gpuBytes = 0;
};
PassSize sizeOf(const BitGrid& grid);
PassSize sizeOf(const OpacityPyramid& pyramid);
PassSize sizeOf(const Rsm& rsm);
PassSize sizeOf(const Lrsm& lrsm);
PassSize sizeOf(const GBuffer& gbuffer);
PassSize sizeOf(const Gathered& gathered);
PassSize sizeOf(const Image<Vec3>& image);

/// SHA-256 of a pass's output: every value, no padding, no timing.
std::string hashOf(const BitGrid& grid);
std::string hashOf(const OpacityPyramid& pyramid);
std::string hashOf(const Rsm& rsm);
std::string hashOf(const Lrsm& lrsm);
std::string hashOf(const GBuffer& gbuffer);
std::string hashOf(const Gathered& gathered);
std::string hashOf(const Image<Vec3>& image);

/// NaNs and infinities among the values that a pass hands on. None may leave a pass, whatever comes in; one read of the output, which is
/// little beside making it.
std::uint64_t countNonFinite(const BitGrid& grid);
std::uint64_t countNonFinite(const OpacityPyramid& pyramid);
std::uint64_t countNonFinite(const Rsm& rsm);
std::uint64_t countNonFinite(const Lrsm& lrsm);
std::uint64_t countNonFinite(const GBuffer& gbuffer);
std::uint64_t countNonFinite(const Gathered& gathered);
std::uint64_t countNonFinite(const Image<Vec3>& image);

/// Of all threads of the process, ms: what other programs on the machine take does not count.
inline double processorMilliseconds()
{
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

class PassLog {
  public:
    PassLog(const RenderOptions& options, int passes) : options_(options), passes_(passes) {}

    template <class Pass>
    auto run(const std::string& name, Pass&& pass)
    {
        if (options_.progress) options_.progress(name, static_cast<double>(reports.size()) / passes_);
        const auto begin = std::chrono::steady_clock::now();
        const double cpuBegin = processorMilliseconds();
        auto output = std::forward<Pass>(pass)();
        const double cpu = processorMilliseconds() - cpuBegin;
        const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
        const PassSize size = sizeOf(output);
        reports.push_back(
            {name, elapsed.count(), cpu, size.bytes, size.gpuBytes, options_.hashPasses ? hashOf(output) : std::string(), countNonFinite(output)});
        return output;
    }

    std::vector<PassReport> reports;

  private:
    const RenderOptions& options_;
    int passes_;
};

}  // namespace lrsm
