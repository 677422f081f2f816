#include "core/base/memory.h"

#include "core/base/errors.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

namespace lrsm {
namespace {

constexpr std::size_t kUnknown = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kUnasked = 64'000'000;

/// The number after `key` in a file of "key number" lines; without a key the file's first word.
std::optional<std::size_t> numberIn(const char* path, const std::string& key)
{
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string word;
        std::size_t number = 0;
        if (!key.empty() && (!(words >> word) || word != key)) continue;
        if (words >> number) return number;
        return {};  // "max": no limit
    }
    return {};
}

std::string gigabytes(std::size_t bytes)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f GB", static_cast<double>(bytes) * 1e-9);
    return text;
}

}  // namespace

std::size_t availableMemory()
{
    std::size_t available = kUnknown;
    if (const auto kilobytes = numberIn("/proc/meminfo", "MemAvailable:")) available = *kilobytes * 1024;
    const auto limit = numberIn("/sys/fs/cgroup/memory.max", ""), used = numberIn("/sys/fs/cgroup/memory.current", "");
    if (limit && used) {
        const std::size_t cached = numberIn("/sys/fs/cgroup/memory.stat", "inactive_file").value_or(0);  // given back when asked for
        const std::size_t held = *used - std::min(*used, cached);
        available = std::min(available, *limit - std::min(*limit, held));
    }
    return available;
}

void requireMemory(std::size_t bytes, const std::string& place, const std::string& remedy)
{
    if (bytes < kUnasked) return;
    const std::size_t available = availableMemory();
    if (bytes > available) throw MachineError(place, "needs " + gigabytes(bytes) + ", and the machine has " + gigabytes(available) + "; " + remedy);
}

}  // namespace lrsm
