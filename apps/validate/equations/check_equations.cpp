#include "apps/validate/equations/check_equations.h"

#include "apps/validate/equations/check_run.h"
#include "core/base/errors.h"
#include "core/base/text.h"

#include <algorithm>

namespace lrsm {
namespace {

/// A file of checks: the equations its rows may carry, and roughly its share of the whole time.
struct Group {
    const char* title;
    std::vector<std::string> equations;
    void (*check)(CheckRun&);
    double share;
};

const std::vector<Group>& groups()
{
    static const std::vector<Group> all = {
        {"Eq. 12: normal distribution and visible fraction", {"12"}, checkGaussian, 6},
        {"Eq. 1: the march along a cone", {"1"}, checkCones, 2},
        {"Eq. 2, 3, 4, 7: direct sums", {"2", "3", "4", "7", "12"}, checkDirectSums, 1},
        {"Eq. 8, 10, 11: terms of Algorithm 1", {"8", "10", "11", "sec5"}, checkTerms, 1},
        {"Eq. 5, 9, 14, 15: sampler, Algorithm 1", {"5", "9", "14", "15"}, checkSample, 2},
        {"Eq. 6, 13-15: layers and their means", {"6", "8", "10", "11", "13", "14", "15", "table1"}, checkLayers, 2},
        {"Sec. 3.1: voxel pyramid and lookup", {"sec3"}, checkVoxels, 1},
        {"Fig. 7: cones", {"fig7"}, checkConeSets, 1},
        {"Table 1: formats", {"table1"}, checkFormats, 1},
        {"Table 1: what storage costs", {"table1"}, addStorageTrades, 1},
        {"elementary functions", {"base"}, checkElementary, 4},
    };
    return all;
}

}  // namespace

bool EquationReport::holds() const
{
    return !checks.empty() && std::all_of(checks.begin(), checks.end(), [](const EquationCheck& check) { return check.holds(); });
}

std::vector<std::string> equationNames()
{
    return {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "sec3", "sec5", "fig7", "table1", "base"};
}

EquationReport checkEquations(const EquationOptions& options)
{
    const std::vector<std::string> names = equationNames();
    if (options.equation && std::find(names.begin(), names.end(), *options.equation) == names.end())
        throw InputError("equation \"" + *options.equation + "\"", "there is no check of this name; there are " + joined(names));
    const auto wanted = [&](const Group& group) {
        return !options.equation || std::find(group.equations.begin(), group.equations.end(), *options.equation) != group.equations.end();
    };
    double total = 0.0, done = 0.0;
    for (const Group& group : groups()) total += wanted(group) ? group.share : 0.0;

    EquationReport report;
    CheckRun run(options, report);
    for (const Group& group : groups()) {
        if (!wanted(group)) continue;
        if (options.progress) options.progress(group.title, done / total);
        group.check(run);
        done += group.share;
    }

    // A group may hold more than the one equation asked for.
    if (options.equation) {
        std::erase_if(report.checks, [&](const EquationCheck& check) { return check.equation != *options.equation; });
        std::erase_if(report.curves, [&](const EquationCurve& curve) { return curve.equation != *options.equation; });
    }
    // The equations in the paper's order, whatever group they come from.
    const auto place = [&](const std::string& equation) { return std::find(names.begin(), names.end(), equation) - names.begin(); };
    std::stable_sort(report.checks.begin(), report.checks.end(), [&](const auto& a, const auto& b) { return place(a.equation) < place(b.equation); });
    if (options.progress) options.progress("done", 1.0);
    return report;
}

}  // namespace lrsm
