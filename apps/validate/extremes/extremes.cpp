#include "apps/validate/extremes/extremes.h"

#include "apps/validate/extremes/catalogue.h"
#include "core/base/errors.h"
#include "core/report/table.h"

#include <algorithm>
#include <cmath>

namespace lrsm {
namespace extremes {

namespace {

/// One run; whatever it throws is a finding.
void runOnce(const Case& entry, Mode mode, Probe& probe)
{
    try {
        entry.run(mode, probe);
        if (entry.mustRefuse) probe.require(false, "taken, where a refusal is due");
    } catch (const InputError& error) {
        if (entry.mustRefuse && isClear(error.what())) {
            probe.refused(error.what());
        } else {
            probe.require(false, std::string(entry.mustRefuse ? "unclear refusal: " : "refused: ") + error.what());
        }
    } catch (const MachineError& error) {
        probe.skip(error.what());
    } catch (const std::exception& error) {
        probe.require(false, std::string("threw ") + error.what());
    }
}

}  // namespace

const char* nameOf(Mode mode)
{
    switch (mode) {
    case Mode::gpuD3d: return "gpu d3d";
    case Mode::gpuNearestEven: return "gpu nearest_even";
    case Mode::float32: return "float32";
    default: return "any";
    }
}

bool isClear(const std::string& line)
{
    return line.size() > 10 && line.size() < 600 && line.find('\n') == std::string::npos && line.find(": ") != std::string::npos;
}

void Probe::bound(const std::string& name, double value, double limit)
{
    note(value);
    ++bounds_;
    const double share = std::abs(value) / std::max(limit, 1e-300);
    const std::string text = name + " " + shortNumber(value) + ", bound " + shortNumber(limit);
    if (!(std::abs(value) <= limit)) require(false, text);
    if (share > worstShare_) {
        worstShare_ = share;
        worst_ = text;
    }
}

void Probe::require(bool holds, const std::string& what)
{
    if (!holds && broken_.size() < 400) broken_ += (broken_.empty() ? "" : "; ") + what;
}

void Probe::checkFinite(const std::string& pass, std::uint64_t count)
{
    ++passes_;
    if (count > 0) require(false, std::to_string(count) + " NaN or infinite values leave " + pass);
}

void Probe::frame(const Frame& frame)
{
    for (const PassReport& pass : frame.passes) {
        checkFinite("pass " + pass.name, pass.nonFinite);
        note(pass.sha256);
    }
    output("indirect diffuse", frame.indirectDiffuse);
    output("indirect specular", frame.indirectSpecular);
    require(counterSum(frame.passes, "nans") == 0.0, "a NaN was converted");
}

void Probe::refuses(const std::string& what, const std::string& says, const std::function<void()>& run)
{
    ++refusals_;
    try {
        run();
        require(false, what + ": taken, where a refusal is due");
    } catch (const InputError& error) {
        const std::string line = error.what();
        note(line);
        refusal_ = line;
        require(isClear(line) && line.find(says) != std::string::npos, what + ": unclear refusal: " + line);
    }
}

void Probe::refused(const std::string& line)
{
    ++refusals_;
    refusal_ = line;
    note(line);
}

ExtremeResult Probe::result() const
{
    ExtremeResult result;
    result.outcome = broken()                                  ? Outcome::broken
                     : !skipped_.empty()                       ? Outcome::skipped
                     : refusals_ > 0 && bounds_ + passes_ == 0 ? Outcome::refused
                                                               : Outcome::held;
    if (broken()) {
        result.detail = broken_;
    } else if (!skipped_.empty()) {
        result.detail = skipped_;
    } else {
        if (passes_ > 0) result.detail = std::to_string(passes_) + " outputs finite";
        if (bounds_ > 0) result.detail += (result.detail.empty() ? "" : "; ") + worst_ + (bounds_ > 1 ? " (nearest of " + std::to_string(bounds_) + ")" : "");
        if (refusals_ > 0)
            result.detail += (result.detail.empty() ? "" : "; ") + refusal_ + (refusals_ > 1 ? " (last of " + std::to_string(refusals_) + ")" : "");
    }
    return result;
}

std::string Probe::fingerprint() const
{
    return Sha256().add(values_).add(texts_ + broken_ + refusal_ + skipped_).hex();
}

ExtremeResult runCase(const Group& group, const Case& entry, Mode mode)
{
    Probe first, second;
    runOnce(entry, mode, first);
    runOnce(entry, mode, second);
    if (first.fingerprint() != second.fingerprint()) first.require(false, "two runs differ");
    ExtremeResult result = first.result();
    result.name = entry.name;
    result.group = group.name;
    result.what = entry.what;
    result.mustHold = entry.mustHold;
    result.storage = nameOf(mode);
    return result;
}

}  // namespace extremes

bool ExtremesReport::held() const
{
    return std::none_of(results.begin(), results.end(), [](const ExtremeResult& r) { return r.outcome == Outcome::broken; });
}

ExtremesReport runExtremes(const ExtremesOptions& options)
{
    using namespace extremes;
    const auto asked = [&](const std::string& group, const std::string& name) {
        return group.find(options.only) != std::string::npos || name.find(options.only) != std::string::npos;
    };

    struct Job {
        const Group* group;
        const Case* entry;
        Mode mode;
    };
    const std::vector<Group> groups = {momentCases(), layerCases(),  storageCases(), depthCases(),      geometryCases(), scaleCases(),
                                       lightCases(),  cameraCases(), coneCases(),    resolutionCases(), settingCases(),  fileCases()};
    std::vector<Job> jobs;
    for (const Group& group : groups)
        for (const Case& entry : group.cases) {
            if (!asked(group.name, entry.name)) continue;
            if (entry.storesNothing)
                jobs.push_back({&group, &entry, Mode::any});
            else
                for (const Mode mode : kStorageModes) jobs.push_back({&group, &entry, mode});
        }
    std::vector<CurvePlan> curves;
    for (CurvePlan& plan : curvePlans())
        if (asked("curve", plan.name)) curves.push_back(std::move(plan));

    ExtremesReport report;
    const double total = static_cast<double>(jobs.size() + 10 * curves.size());
    const auto tell = [&](const std::string& name) {
        if (options.progress) options.progress(name, static_cast<double>(report.results.size() + 10 * report.curves.size()) / std::max(total, 1.0));
    };
    for (const Job& job : jobs) {
        tell(job.entry->name);
        report.results.push_back(runCase(*job.group, *job.entry, job.mode));
    }
    for (const CurvePlan& plan : curves) {
        tell(plan.name);
        report.curves.push_back(drawCurve(plan));
    }
    return report;
}

}  // namespace lrsm
