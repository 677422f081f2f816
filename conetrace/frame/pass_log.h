#pragma once

#include "core/base/arrays.h"
#include "core/base/counters.h"

#include <chrono>
#include <functional>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

/// Passes report themselves: a pass that runs through PassLog::run is timed, hashed, sized and counted, and whoever watches is shown what it made.
/// frame.json, sweeps, benchmarks and captures go by these reports, so a new pass is in all of them by itself.
namespace lrsm {

/// What its work and its output depend on.
struct PassTraits {
    bool perPixel = false;  ///< work grows with the picture's pixels
    bool resident = false;  ///< the output is held until the frame is done, and is no picture: counts as the frame's memory
};
inline constexpr PassTraits kWorldPass{.perPixel = false, .resident = true};   ///< part of the world that cones read
inline constexpr PassTraits kPassedOn{.perPixel = false, .resident = false};   ///< goes into a later pass's output
inline constexpr PassTraits kSurfacePass{.perPixel = true, .resident = true};  ///< G-buffer
inline constexpr PassTraits kPicturePass{.perPixel = true, .resident = false};

/// What one pass took and made.
struct PassReport {
    std::string name;  ///< "voxelize", "rsm 0": a number at the end tells passes of one family apart
    PassTraits traits;
    double milliseconds = 0.0;
    double cpuMilliseconds = 0.0;  ///< processor time of all threads of the process meanwhile
    std::size_t bytes = 0;         ///< held by the pass's output
    std::size_t gpuBytes = 0;      ///< the same in the GPU's formats
    std::string sha256;            ///< of the output; empty unless asked for
    std::uint64_t nonFinite = 0;   ///< NaNs and infinities in the output; the pass is broken where this is not 0
    Counters counters;
    bool kept = false;  ///< the output is an earlier frame's, made from the same; all else is said of its making, but the time
};

/// "rsm 3" is one of the family "rsm".
std::string passFamily(const std::string& pass);

/// Sum over all passes of the counters of this name.
double counterSum(const std::vector<PassReport>& passes, std::string_view name);

/// What a pass made, for who knows its type; lives as long as the call that shows it.
class PassOutput {
  public:
    template <class T>
    explicit PassOutput(const T& output) : data_(&output), type_(&typeid(T))
    {
    }
    /// nullptr where it is something else.
    template <class T>
    const T* as() const
    {
        return *type_ == typeid(T) ? static_cast<const T*>(data_) : nullptr;
    }

  private:
    const void* data_;
    const std::type_info* type_;
};

struct PassWatch {
    bool hashPasses = true;                                                          ///< SHA-256 of each pass's output; its time is not counted in the pass
    std::function<void(const std::string& pass, double fraction)> progress;          ///< before each pass; may be empty
    std::function<void(const std::string& pass, const PassOutput& output)> observe;  ///< after each pass; may be empty; changes no bit
};

/// Of all threads of the process, ms: what other programs on the machine take does not count.
double processorMilliseconds();

class PassLog {
  public:
    /// `watch` must outlive the log. `expectedPasses` is for the progress bar alone.
    explicit PassLog(const PassWatch& watch, std::size_t expectedPasses = 0) : watch_(watch), expected_(expectedPasses) {}

    /// Runs `pass` and returns what it made.
    template <class Pass>
    auto run(const std::string& name, const PassTraits& traits, Pass&& pass)
    {
        begin(name);
        const auto started = std::chrono::steady_clock::now();
        const double cpuStarted = processorMilliseconds();
        auto output = std::forward<Pass>(pass)();
        const double cpu = processorMilliseconds() - cpuStarted;
        const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - started;

        reports.push_back({.name = name,
                           .traits = traits,
                           .milliseconds = elapsed.count(),
                           .cpuMilliseconds = cpu,
                           .bytes = bytesOf(output),
                           .gpuBytes = gpuBytesOf(output),
                           .sha256 = watch_.hashPasses ? hashOf(output) : std::string(),
                           .nonFinite = countNonFinite(output),
                           .counters = {}});
        if constexpr (requires { countersOf(output); }) reports.back().counters = countersOf(output);
        show(name, output);
        return output;
    }

    /// Reports of passes whose outputs are there already: as they were, in no time.
    void repeat(const std::vector<PassReport>& earlier);

    /// Does anybody want more than the outputs? Then a pass may `show` what it else would not keep.
    bool observed() const { return bool(watch_.observe); }
    template <class Detail>
    void show(const std::string& name, const Detail& detail) const
    {
        if (watch_.observe) watch_.observe(name, PassOutput(detail));
    }

    std::vector<PassReport> reports;

  private:
    void begin(const std::string& name) const;

    const PassWatch& watch_;
    std::size_t expected_;
};

}  // namespace lrsm
