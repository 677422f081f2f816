#include "apps/tune/tune.h"

#include "core/base/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lrsm {

namespace {

/// A point this far over the time budget stands for all costlier ones.
constexpr double kHopelessTime = 1.5;
/// How far predictions that a verification has corrected are off, as seen in scenes: up to a few percent.
constexpr double kNear = 1.05;
/// Points that meet the budget by prediction before the rest is left unprobed: one to choose, one for when it fails.
constexpr int kEnough = 2;

struct Known {
    std::size_t index;
    TuneFigures figures;
    bool verified;
};

class Tuner {
  public:
    Tuner(std::vector<TunePoint> points, const TuneRequest& request, const TuneActions& actions) : request_(request), actions_(actions)
    {
        result_.points = std::move(points);
        result_.scale = request.before;
        for (TunePoint& point : result_.points)
            if (request_.budget.megabytes && point.megabytes > *request_.budget.megabytes) point.skipped = "over the memory";
    }

    TuneResult run()
    {
        for (int verifications = 0;;) {
            probeUntilEnough();
            const bool mayVerify = verifications < request_.maxVerifications;
            std::optional<Known> next = best(mayVerify ? 1.0 : 0.0);
            if (next && next->verified) {
                // A better one that the prediction puts just outside is worth a look.
                const std::optional<Known> near = best(mayVerify ? kNear : 0.0);
                if (!near || near->verified) {
                    result_.chosen = next->index;
                    break;
                }
                next = near;
            }
            if (!next && mayVerify && probeNext()) continue;
            if (!next) next = nearest();
            if (!next) {
                result_.nearest = leastMemory();
                break;
            }
            if (next->verified || !mayVerify) {
                result_.nearest = next->index;
                break;
            }
            verify(next->index);
            ++verifications;
        }
        for (TunePoint& point : result_.points)
            if (!point.probe && point.skipped.empty()) point.skipped = "not needed";
        return std::move(result_);
    }

  private:
    std::vector<Known> known() const
    {
        std::vector<Known> all;
        for (std::size_t i = 0; i < result_.points.size(); ++i)
            if (const auto figures = figuresOf(result_.points[i], request_, result_.correction, result_.scale))
                all.push_back({i, *figures, result_.points[i].verified.has_value()});
        return all;
    }

    bool meets(const Known& point) const { return excess(point.figures, request_.budget) <= 1.0; }

    /// Of the points within the budget, or where that is only predicted, within `tolerance` times it.
    std::optional<Known> best(double tolerance) const
    {
        std::optional<Known> best;
        for (const Known& point : known()) {
            if (excess(point.figures, request_.budget) > (point.verified ? 1.0 : tolerance)) continue;
            const TuneFigures &a = point.figures, &b = best ? best->figures : a;
            const bool better = request_.budget.error ? a.cost < b.cost : a.error < b.error || (a.error == b.error && a.cost < b.cost);
            if (!best || better) best = point;
        }
        return best;
    }

    std::optional<Known> nearest() const
    {
        std::optional<Known> best;
        for (const Known& point : known())
            if (!best || excess(point.figures, request_.budget) < excess(best->figures, request_.budget)) best = point;
        return best;
    }

    /// Where everything is over the memory.
    std::optional<std::size_t> leastMemory() const
    {
        std::optional<std::size_t> least;
        for (std::size_t i = 0; i < result_.points.size(); ++i)
            if (!least || result_.points[i].megabytes < result_.points[*least].megabytes) least = i;
        return least;
    }

    void probeUntilEnough()
    {
        const auto enough = [&] {
            if (!request_.budget.error) return false;
            const std::vector<Known> all = known();
            return std::count_if(all.begin(), all.end(), [&](const Known& point) { return meets(point); }) >= kEnough;
        };
        while (!enough() && probeNext()) {
        }
    }

    /// False when nothing is left that is worth it.
    bool probeNext()
    {
        TuneBudget time = request_.budget;
        time.error.reset();
        time.megabytes.reset();
        // At best all threads share the work evenly; small frames show less of that than large ones.
        TimeScale best = result_.scale;
        best.wallPerCpu = std::min(best.wallPerCpu, 1.0 / request_.threads);
        for (Known point : known()) {
            point.figures.milliseconds = best.milliseconds(point.figures.cost);
            if (excess(point.figures, time) > kHopelessTime)
                for (std::size_t i = point.index + 1; i < result_.points.size(); ++i)
                    if (!result_.points[i].probe && result_.points[i].skipped.empty()) result_.points[i].skipped = "over the time";
        }
        for (TunePoint& point : result_.points) {
            if (point.probe || !point.skipped.empty()) continue;
            point.probe = actions_.probe(point.named);
            updateScale();
            return true;
        }
        return false;
    }

    void verify(std::size_t index)
    {
        result_.points[index].verified = actions_.verify(result_.points[index].named);
        updateScale();
        // What all verified points say together of the size's influence.
        double error = 0.0, cost = 0.0;
        int count = 0;
        for (const TunePoint& point : result_.points) {
            if (!point.verified) continue;
            TunePoint unverified = point;
            unverified.verified.reset();
            const auto predicted = figuresOf(unverified, request_, {}, result_.scale);
            const auto measured = figuresOf(point, request_, {}, result_.scale);
            if (!predicted || !(predicted->error > 0.0 && measured->error > 0.0 && predicted->cost > 0.0 && measured->cost > 0.0)) continue;
            error += std::log(measured->error / predicted->error);
            cost += std::log(measured->cost / predicted->cost);
            ++count;
        }
        if (count > 0) result_.correction = {std::exp(error / count), std::exp(cost / count)};
    }

    void updateScale()
    {
        std::vector<Measurement> rows;
        for (const TunePoint& point : result_.points)
            for (const auto& row : {point.probe, point.verified})
                if (row) rows.push_back(*row);
        result_.scale = timeScale(request_.before, rows);
    }

    TuneRequest request_;
    const TuneActions& actions_;
    TuneResult result_;
};

}  // namespace

double tunedError(const PictureError& error, TuneMetric metric)
{
    switch (metric) {
    case TuneMetric::flip: return error.flip;
    case TuneMetric::energy: return std::abs(error.energy - 1.0);
    case TuneMetric::rmse: break;
    }
    return error.net();
}

void validate(const TuneBudget& budget)
{
    const auto positive = [](const std::optional<double>& value, const char* name) {
        if (value && !(*value > 0.0 && std::isfinite(*value))) throw InputError(name, "must be a finite number above 0");
    };
    positive(budget.error, "--max-error");
    positive(budget.milliseconds, "--max-time");
    positive(budget.cost, "--max-time");
    positive(budget.megabytes, "--max-memory");
    if (!budget.error && !budget.milliseconds && !budget.cost && !budget.megabytes)
        throw InputError("tune", "needs a budget: --max-error, --max-time, --max-memory, or several of them");
}

std::uint64_t samplesNeeded(double noise, std::uint64_t samples, double error)
{
    const double needed = double(samples) * (noise / error) * (noise / error);
    std::uint64_t power = 1;
    while (double(power) < needed && power < (std::uint64_t(1) << 32)) power *= 2;
    return power;
}

TimeScale timeScale(TimeScale scale, const std::vector<Measurement>& rows)
{
    for (const Measurement& row : rows) {
        if (row.calibrationCpu > 0.0) scale.calibrationCpu = std::min(scale.calibrationCpu, row.calibrationCpu);
        if (row.frameCpu > 0.0) scale.wallPerCpu = std::min(scale.wallPerCpu, row.frame.median / row.frameCpu);
    }
    return scale;
}

double costAtSize(const Measurement& row, int width, int height)
{
    const double pixels = double(width) * double(height) / (double(row.width) * double(row.height));
    double all = 0.0, there = 0.0;
    for (const PassTime& pass : row.passes) {
        all += pass.time.median;
        there += pass.time.median * (pass.perPixel ? pixels : 1.0);
    }
    return all > 0.0 ? row.cost * there / all : row.cost * pixels;
}

std::optional<TuneFigures> figuresOf(const TunePoint& point, const TuneRequest& request, const TuneCorrection& correction, const TimeScale& scale)
{
    TuneFigures figures;
    figures.megabytes = point.megabytes;
    if (point.verified) {
        figures.error = tunedError(point.verified->error, request.budget.metric);
        figures.cost = point.verified->cost;
    } else if (point.probe) {
        figures.error = tunedError(point.probe->error, request.budget.metric) * correction.error;
        figures.cost = costAtSize(*point.probe, request.width, request.height) * correction.cost;
    } else {
        return {};
    }
    figures.milliseconds = scale.milliseconds(figures.cost);
    return figures;
}

double excess(const TuneFigures& figures, const TuneBudget& budget)
{
    double worst = 0.0;
    const auto hold = [&](double figure, const std::optional<double>& limit) {
        if (limit) worst = std::max(worst, std::isnan(figure) ? std::numeric_limits<double>::infinity() : figure / *limit);
    };
    hold(figures.error, budget.error);
    hold(figures.milliseconds, budget.milliseconds);
    hold(figures.cost, budget.cost);
    hold(figures.megabytes, budget.megabytes);
    return worst;
}

TuneResult tune(std::vector<TunePoint> points, const TuneRequest& request, const TuneActions& actions)
{
    validate(request.budget);
    return Tuner(std::move(points), request, actions).run();
}

}  // namespace lrsm
