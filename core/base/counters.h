#pragma once

#include <string>
#include <string_view>
#include <vector>

/// What a pass counted, by name, for reports: frame.json, sweeps and benchmarks show whatever is there. Names are snake_case; an output that counts
/// something has a function countersOf(output) beside it.
namespace lrsm {

struct Counter {
    std::string name;
    double value = 0.0;      ///< counts up to 2^53 are exact
    bool describes = false;  ///< a figure of this output alone, for frame.json: sums over passes leave it out
};
using Counters = std::vector<Counter>;

/// Sum of the counters of this name; 0 where there is none.
inline double counterSum(const Counters& counters, std::string_view name)
{
    double sum = 0.0;
    for (const Counter& counter : counters)
        if (counter.name == name) sum += counter.value;
    return sum;
}

/// Adds to the counter of the same name, or appends it.
inline void addTo(Counters& counters, const Counter& more)
{
    if (more.describes) return;
    for (Counter& counter : counters)
        if (counter.name == more.name) {
            counter.value += more.value;
            return;
        }
    counters.push_back(more);
}

}  // namespace lrsm
