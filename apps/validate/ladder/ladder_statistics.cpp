#include "apps/validate/ladder/ladder_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace lrsm {
namespace {

constexpr std::size_t kCurveBins = 10;
constexpr std::size_t kHistogramBins = 61;

/// Linear between order statistics; `sorted` ascending, not empty.
double quantile(const std::vector<double>& sorted, double probability)
{
    const double at = probability * double(sorted.size() - 1);
    const auto low = static_cast<std::size_t>(at);
    const std::size_t high = std::min(low + 1, sorted.size() - 1);
    return sorted[low] + (at - double(low)) * (sorted[high] - sorted[low]);
}

struct MeanAndRms {
    double mean, rms;
};
MeanAndRms meanAndRms(const std::vector<double>& values)
{
    double sum = 0.0, squares = 0.0;
    for (const double v : values) sum += v, squares += v * v;
    return {sum / double(values.size()), std::sqrt(squares / double(values.size()))};
}

double weightedMean(std::span<const double> values, std::span<const double> weights)
{
    double sum = 0.0, total = 0.0, plain = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        sum += weights[i] * values[i];
        total += weights[i];
        plain += values[i];
    }
    return total > 0.0 ? sum / total : plain / double(std::max<std::size_t>(values.size(), 1));
}

std::vector<double> differencesBetween(const LadderView& view, const std::vector<LadderSample>& samples, const std::vector<std::size_t>& included,
                                       std::size_t rung, std::size_t other)
{
    std::vector<double> differences;
    differences.reserve(included.size());
    for (const std::size_t i : included) differences.push_back(view.value(samples[i], rung) - view.value(samples[i], other));
    return differences;
}

/// Symmetric about 0, reaching the largest 99th percentile of any difference.
std::vector<double> histogramEdges(const std::vector<RungStatistics>& rungs)
{
    double reach = 0.0;
    for (const RungStatistics& rung : rungs) reach = std::max({reach, rung.toAbove.p99, rung.toTop.p99});
    if (!(reach > 0.0)) reach = 1.0;
    std::vector<double> edges;
    for (std::size_t i = 0; i <= kHistogramBins; ++i) edges.push_back(reach * (2.0 * double(i) / double(kHistogramBins) - 1.0));
    return edges;
}

std::vector<std::size_t> histogram(const std::vector<double>& differences, const std::vector<double>& edges)
{
    std::vector<std::size_t> counts(edges.size() - 1, 0);
    for (const double d : differences) {
        const auto above = std::upper_bound(edges.begin(), edges.end(), d) - edges.begin();
        ++counts[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ptrdiff_t(counts.size()) - 1))];
    }
    return counts;
}

CurveBin describeBin(const LadderView& view, const std::vector<LadderSample>& samples, const std::vector<std::size_t>& members)
{
    CurveBin bin;
    bin.count = members.size();
    for (std::size_t rung = 0; rung < view.rungs.size(); ++rung) {
        const MeanAndRms above = meanAndRms(differencesBetween(view, samples, members, rung, rung ? rung - 1 : 0)),
                         top = meanAndRms(differencesBetween(view, samples, members, rung, 0));
        bin.meanToAbove.push_back(above.mean), bin.rmsToAbove.push_back(above.rms);
        bin.meanToTop.push_back(top.mean), bin.rmsToTop.push_back(top.rms);
    }
    return bin;
}

LadderCurve describeCurve(const LadderView& view, const LadderView::Variable& variable, const std::vector<LadderSample>& samples,
                          std::vector<std::size_t> members)
{
    const auto valueOf = [&](std::size_t i) { return variable.value(samples[i]); };
    std::sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
        const double va = valueOf(a), vb = valueOf(b);
        return va != vb ? va < vb : a < b;
    });
    LadderCurve curve{variable.name, variable.unit, {}};
    const std::size_t perBin = variable.integer ? 1 : std::max<std::size_t>(1, (members.size() + kCurveBins - 1) / kCurveBins);
    for (std::size_t begin = 0; begin < members.size();) {
        std::size_t end = std::min(begin + perBin, members.size());
        while (end < members.size() && valueOf(members[end]) == valueOf(members[end - 1])) ++end;  // equal values share a bin
        CurveBin bin = describeBin(view, samples, {members.begin() + std::ptrdiff_t(begin), members.begin() + std::ptrdiff_t(end)});
        bin.low = valueOf(members[begin]);
        bin.high = end < members.size() ? valueOf(members[end]) : std::nextafter(valueOf(members[end - 1]), HUGE_VAL);
        curve.bins.push_back(std::move(bin));
        begin = end;
    }
    return curve;
}

void addWorst(Ladder& ladder, const std::string& rung, bool toTop, const std::vector<double>& differences, const std::vector<std::size_t>& included, int count)
{
    std::vector<std::size_t> order(differences.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    const std::size_t kept = std::min(order.size(), static_cast<std::size_t>(std::max(count, 0)));
    std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(kept), order.end(), [&](std::size_t a, std::size_t b) {
        const double da = std::abs(differences[a]), db = std::abs(differences[b]);
        return da != db ? da > db : a < b;
    });
    for (std::size_t i = 0; i < kept; ++i)
        if (differences[order[i]] != 0.0) ladder.worst.push_back({rung, toTop, differences[order[i]], included[order[i]]});
}

std::string verdictOf(const LadderView& view, const Ladder& ladder)
{
    const auto worst =
        std::max_element(ladder.rungs.begin(), ladder.rungs.end(), [](const RungStatistics& a, const RungStatistics& b) { return a.share < b.share; });
    const RungStatistics &top = ladder.rungs.front(), &last = ladder.rungs.back();
    if (!(worst->share > 0.0)) return "All rungs agree on " + view.quantity + ".";
    const RungStatistics& above = *(worst - 1);
    char line[640];
    std::snprintf(line, sizeof line,
                  "Most of the error of %s enters at \"%s\" (%s): rms %.3g, %.0f %% of the squared steps; there the mean goes from %.3g to %.3g, on the whole "
                  "way from %.3g to %.3g, rms %.3g.",
                  view.quantity.c_str(), worst->name.c_str(), worst->meaning.c_str(), worst->toAbove.rms, 100.0 * worst->share, above.mean, worst->mean,
                  top.mean, last.mean, last.toTop.rms);
    return line;
}

}  // namespace

DifferenceStatistics describeDifferences(std::vector<double> differences, std::span<const double> weights)
{
    DifferenceStatistics statistics;
    if (differences.empty()) return statistics;
    statistics.weightedMean = weightedMean(differences, weights);
    const MeanAndRms both = meanAndRms(differences);
    statistics.mean = both.mean;
    statistics.rms = both.rms;
    std::sort(differences.begin(), differences.end());
    for (const double p : ladderProbabilities()) statistics.quantiles.push_back(quantile(differences, p));
    for (double& d : differences) d = std::abs(d);
    std::sort(differences.begin(), differences.end());
    statistics.p50 = quantile(differences, 0.5);
    statistics.p95 = quantile(differences, 0.95);
    statistics.p99 = quantile(differences, 0.99);
    statistics.max = differences.back();
    return statistics;
}

LadderView radianceView()
{
    return {"the radiance L",
            radianceRungs(),
            [](const LadderSample& s, std::size_t rung) { return s.radiance[rung]; },
            {{"r_c", "m", [](const LadderSample& s) { return double(s.radius); }},
             {"level", "", [](const LadderSample& s) { return s.level; }},
             {"slope", "<n.l>", [](const LadderSample& s) { return s.slope; }},
             {"l.v", "", [](const LadderSample& s) { return s.lightCosine; }},
             {"layers", "", [](const LadderSample& s) { return double(s.layers); }, true}},
            [](const LadderSample& s) { return s.weight; }};
}

LadderView visibilityView()
{
    return {"the cones' opacity",
            visibilityRungs(),
            [](const LadderSample& s, std::size_t rung) { return s.opacity[rung]; },
            {{"distance", "m", [](const LadderSample& s) { return double(s.distance); }},
             {"r_c", "m", [](const LadderSample& s) { return double(s.radius); }},
             {"voxel level", "", [](const LadderSample& s) { return s.voxelLevel; }}},
            [](const LadderSample& s) { return s.weight; }};
}

LadderView emissionView()
{
    return {"what a segment emits",
            emissionRungs(),
            [](const LadderSample& s, std::size_t rung) { return s.emission[rung]; },
            {{"distance", "m", [](const LadderSample& s) { return double(s.distance); }},
             {"r_c", "m", [](const LadderSample& s) { return double(s.radius); }},
             {"slope", "<n.l>", [](const LadderSample& s) { return s.slope; }},
             {"layers", "", [](const LadderSample& s) { return double(s.layers); }, true}},
            [](const LadderSample& s) { return s.emissionWeight; }};
}

Ladder describeLadder(const LadderView& view, const std::vector<LadderSample>& samples, const std::vector<std::size_t>& included, int worstPerRung)
{
    Ladder ladder;
    ladder.samples = included.size();
    std::vector<double> weights;
    for (const std::size_t i : included) weights.push_back(view.weight(samples[i]));

    double squares = 0.0;
    std::vector<std::vector<double>> toAbove, toTop;
    for (std::size_t rung = 0; rung < view.rungs.size(); ++rung) {
        toAbove.push_back(differencesBetween(view, samples, included, rung, rung ? rung - 1 : 0));
        toTop.push_back(differencesBetween(view, samples, included, rung, 0));
        RungStatistics statistics{view.rungs[rung].name, view.rungs[rung].meaning, 0.0, 0.0, {}, {}, 0.0};
        std::vector<double> values;
        for (const std::size_t i : included) values.push_back(view.value(samples[i], rung));
        statistics.mean = values.empty() ? 0.0 : std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
        statistics.weightedMean = weightedMean(values, weights);
        statistics.toAbove = describeDifferences(toAbove.back(), weights);
        statistics.toTop = describeDifferences(toTop.back(), weights);
        squares += statistics.toAbove.rms * statistics.toAbove.rms;
        ladder.rungs.push_back(std::move(statistics));
    }

    ladder.histogramEdges = histogramEdges(ladder.rungs);
    for (std::size_t rung = 0; rung < view.rungs.size(); ++rung) {
        RungStatistics& statistics = ladder.rungs[rung];
        statistics.share = squares > 0.0 ? statistics.toAbove.rms * statistics.toAbove.rms / squares : 0.0;
        statistics.toAbove.histogram = histogram(toAbove[rung], ladder.histogramEdges);
        statistics.toTop.histogram = histogram(toTop[rung], ladder.histogramEdges);
        if (rung > 0) addWorst(ladder, statistics.name, false, toAbove[rung], included, worstPerRung);
    }
    addWorst(ladder, ladder.rungs.back().name, true, toTop.back(), included, worstPerRung);
    for (const LadderView::Variable& variable : view.variables) ladder.curves.push_back(describeCurve(view, variable, samples, included));
    ladder.verdict = verdictOf(view, ladder);
    return ladder;
}

}  // namespace lrsm
