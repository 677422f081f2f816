#pragma once

#include "apps/validate/equations/check_equations.h"
#include "apps/validate/equations/worst_case.h"

#include <chrono>

/// What the groups of checks share: where their rows go, how much they may spend, how they are timed.
namespace lrsm {

class CheckRun {
  public:
    CheckRun(const EquationOptions& options, EquationReport& report) : options_(options), report_(report) {}

    /// A budget at effort 1, scaled; never below `least`, so that planted points and a few climbs remain.
    std::uint64_t scaled(double atFullEffort, double least = 200.0) const
    {
        return static_cast<std::uint64_t>(std::max(least, atFullEffort * options_.effort));
    }
    SearchBudget budget(double atFullEffort) const { return {scaled(atFullEffort), scaled(atFullEffort)}; }
    /// Draws of a check that makes a whole map, grid or cone for each.
    std::uint64_t draws(double atFullEffort) const { return scaled(atFullEffort, 1.0); }

    /// Median time of call(i), i running over [0, inputs), in nanoseconds; 0 where speed is not measured. What the calls return is summed into a volatile, so
    /// that none is left out.
    template <class Call>
    double time(std::size_t inputs, const Call& call) const
    {
        if (!options_.measureSpeed) return 0.0;
        constexpr int kRuns = 9;
        std::array<double, kRuns> times{};
        volatile double sink = 0.0;
        for (double& time : times) {
            const auto start = std::chrono::steady_clock::now();
            double sum = 0.0;
            for (std::size_t i = 0; i < inputs; ++i) sum += static_cast<double>(call(i));
            sink = sink + sum;
            time = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() / static_cast<double>(inputs);
        }
        std::nth_element(times.begin(), times.begin() + kRuns / 2, times.end());
        return times[kRuns / 2];
    }

    template <class T, std::size_t N>
    void add(EquationCheck check, const Worst<T, N>& worst, const std::string& worstInput)
    {
        check.worst = worst.error;
        check.meanError = worst.mean();
        check.evaluations = worst.evaluations;
        check.worstInput = worstInput;
        report_.checks.push_back(std::move(check));
    }
    void add(EquationTrade trade) { report_.trades.push_back(std::move(trade)); }
    void add(EquationCurve curve) { report_.curves.push_back(std::move(curve)); }

  private:
    const EquationOptions& options_;
    EquationReport& report_;
};

/// A row in which every result must be the oracle's.
inline EquationCheck exactCheck(const std::string& equation, const std::string& function, const std::string& oracle, const std::string& domain)
{
    return {.equation = equation, .function = function, .oracle = oracle, .domain = domain, .errorKind = "wrong results", .bound = {"exact", 0.0}};
}

/// The groups, each in a file of its own.
void checkElementary(CheckRun& run);   // "base"
void checkFormats(CheckRun& run);      // "table1"
void checkGaussian(CheckRun& run);     // "12"
void checkTerms(CheckRun& run);        // "8", "10", "11", "sec5"
void checkCones(CheckRun& run);        // "1"
void checkVoxels(CheckRun& run);       // "sec3"
void checkConeSets(CheckRun& run);     // "fig7"
void addStorageTrades(CheckRun& run);  // trades and a curve of "table1"
void checkDirectSums(CheckRun& run);   // "2", "3", "4", "7", and "12" as a model of "7"
void checkLayers(CheckRun& run);       // "6", "8", "10", "11", "13", "14", "15", "table1"
void checkSample(CheckRun& run);       // "5", "9", "14", "15"

}  // namespace lrsm
