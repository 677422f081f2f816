#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/common/memory.h"
#include "apps/common/progress.h"
#include "apps/info/advice.h"
#include "apps/sweep/measure.h"
#include "apps/sweep/operating_points.h"
#include "apps/sweep/truth.h"
#include "apps/tune/tune.h"
#include "apps/tune/tune_report.h"
#include "conetrace/lrsm/memory.h"
#include "core/base/errors.h"
#include "core/base/output_folder.h"
#include "core/base/parallel.h"
#include "core/report/table.h"
#include "core/scene/scene_hash.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <thread>

namespace lrsm {

namespace {

constexpr int kCalibrationRuns = 12;
constexpr std::uint64_t kMaxSamples = std::uint64_t(1) << 24;

struct TuneArguments : CommonOptions {
    std::string output, references, metric = "rmse", maxTime, probe = "320x180";
    double maxError = 0.0, maxMemory = 0.0;
    std::uint64_t samples = 1024;
    bool nearest = false, untrimmed = false, hasError = false, hasMemory = false;
};

/// "40", "40ms": milliseconds; "3.5cal": calibration frames.
void readTime(const std::string& text, TuneBudget& budget)
{
    std::string number = text;
    const auto endsWith = [&](const std::string& unit) {
        if (!number.ends_with(unit)) return false;
        number.resize(number.size() - unit.size());
        return true;
    };
    const bool frames = endsWith("cal");
    if (!frames) endsWith("ms");
    double value = 0.0;
    if (number.empty() || !CLI::detail::lexical_cast(number, value))
        throw InputError("--max-time " + text, "must be milliseconds (40 or 40ms) or calibration frames (3.5cal)");
    (frames ? budget.cost : budget.milliseconds) = value;
}

TuneBudget chosenBudget(const TuneArguments& options)
{
    TuneBudget budget;
    if (options.hasError) budget.error = options.maxError;
    if (options.hasMemory) budget.megabytes = options.maxMemory;
    if (!options.maxTime.empty()) readTime(options.maxTime, budget);
    if (options.metric == "flip")
        budget.metric = TuneMetric::flip;
    else if (options.metric == "energy")
        budget.metric = TuneMetric::energy;
    else if (options.metric != "rmse")
        throw InputError("--metric " + options.metric, "must be rmse, flip or energy");
    validate(budget);
    return budget;
}

/// Light maps are the same for many points: each kind is looked at once.
class KnownMaps {
  public:
    KnownMaps(const Scene& scene, const Camera& camera, const IVec2& size) : scene_(scene), camera_(camera), size_(size) {}

    SceneAnalysis analyse(const Settings& settings)
    {
        const auto known = std::find_if(analyses_.begin(), analyses_.end(), [&](const auto& each) { return sameMaps(each.first, settings); });
        const SceneAnalysis analysis = analyseScene(scene_, camera_, analyseRequirements(scene_, settings.force), settings, size_.x, size_.y,
                                                    known == analyses_.end() ? nullptr : &known->second);
        if (known == analyses_.end()) analyses_.emplace_back(settings, analysis);
        return analysis;
    }

    /// Bytes of a frame of the size.
    std::size_t bytes(const Settings& settings)
    {
        const Requirements needs = analyseRequirements(scene_, settings.force);
        MemoryQuestion question{scene_, needs, settings, size_.x, size_.y};
        const auto known = std::find_if(layers_.begin(), layers_.end(), [&](const auto& each) { return sameMaps(each.first, settings); });
        question.layersKept = known == layers_.end() ? layersKept(question) : known->second;
        if (known == layers_.end()) layers_.emplace_back(settings, question.layersKept);
        return frameBytes(predictMemory(question), size_.x, size_.y);
    }

  private:
    const Scene& scene_;
    const Camera& camera_;
    IVec2 size_;
    std::vector<std::pair<Settings, SceneAnalysis>> analyses_;
    std::vector<std::pair<Settings, std::vector<int>>> layers_;
};

/// Takes out what this scene, seen like this, does not require; says what.
std::vector<std::string> trim(Settings& settings, const Scene& scene, KnownMaps& maps, const IVec2& size)
{
    const SceneAnalysis analysis = maps.analyse(settings);
    const std::vector<Advice> advice = adviseSettings(scene, analysis, settings, size.x, size.y);
    std::vector<std::string> trimmed;
    for (const Advice& change : advice) trimmed.push_back(change.key + " " + change.from + " -> " + change.to + ": " + change.why);
    settings = applyAdvice(settings, advice);
    return trimmed;
}

/// The shipped points with the user's --set over each, what the scene does not require taken out, and their bytes at the asked size.
std::vector<TunePoint> chosenPoints(const TuneArguments& options, const Scene& scene, const Camera& camera, const IVec2& size)
{
    std::vector<TunePoint> points;
    KnownMaps maps(scene, camera, size);
    for (NamedSettings& named : operatingPoints()) {
        for (const std::string& assignment : options.assignments) applySetting(named.settings, assignment);
        validate(named.settings);
        std::vector<std::string> trimmed;
        if (!options.untrimmed) trimmed = trim(named.settings, scene, maps, size);
        // What the user has fixed stays.
        for (const std::string& assignment : options.assignments) applySetting(named.settings, assignment);
        validate(named.settings);
        const auto same = [&](const TunePoint& point) { return point.named.settings == named.settings; };
        if (std::any_of(points.begin(), points.end(), same)) continue;

        points.push_back(
            {.named = named, .megabytes = double(maps.bytes(named.settings)) * 1e-6, .probe = {}, .verified = {}, .skipped = {}, .trimmed = trimmed});
    }
    return points;
}

/// The case at one size, with its truth.
class SizedCase {
  public:
    SizedCase(SceneCase& sceneCase, const IVec2& size, Truth truth) : case_(sceneCase), size_(size), truth_(std::move(truth)), figures_(lrsm::figuresOf(truth_))
    {
    }

    Measurement measure(const NamedSettings& named, const Calibration& calibration, const MeasureOptions& options)
    {
        case_.width = size_.x;
        case_.height = size_.y;
        std::swap(case_.truth, truth_);
        Measured measured = measureSettings(case_, figures_, named.settings, calibration, options);
        std::swap(case_.truth, truth_);
        measured.row.label = named.label;
        return measured.row;
    }
    const TruthFigures& figures() const { return figures_; }
    std::uint64_t samples() const { return truth_.samples; }

  private:
    SceneCase& case_;
    IVec2 size_;
    Truth truth_;
    TruthFigures figures_;
};

int threadsOf(const TuneArguments& options)
{
    const int all = std::max(1, int(std::thread::hardware_concurrency()));
    return options.threads > 0 ? std::min(options.threads, all) : all;
}

/// What is asked for must be above what the truth can tell.
void refuseBelowNoise(const TuneBudget& budget, const TruthFigures& figures, std::uint64_t samples)
{
    if (!budget.error || budget.metric != TuneMetric::rmse || *budget.error >= figures.noise) return;
    const std::uint64_t needed = samplesNeeded(figures.noise, samples, *budget.error);
    throw InputError("--max-error " + shortNumber(*budget.error),
                     "is below the noise of the truth itself, " + shortNumber(figures.noise) + " at " + std::to_string(samples) + " samples a pixel; " +
                         (needed <= kMaxSamples ? "ask with --spp " + std::to_string(needed) : "no number of samples that this program takes would show it"));
}

/// Samples for the asked size: noise half of the error that is to be seen, which is enough to take it out again.
std::uint64_t verifyingSamples(const TuneBudget& budget, const Measurement& probe, std::uint64_t samples, std::uint64_t probeSamples)
{
    if (budget.metric != TuneMetric::rmse) return samples;
    const double error = std::max(budget.error.value_or(0.0), probe.error.net());
    return std::clamp(samplesNeeded(probe.error.noise, probeSamples, 0.5 * error), std::min<std::uint64_t>(256, samples), samples);
}

int runTune(const TuneArguments& options)
{
    const TuneBudget budget = chosenBudget(options);
    if (options.output.empty() && !options.json) throw InputError("tune", "needs -o FILE.json (or --json)");
    const IVec2 size = chosenSize(options);
    CommonOptions probing = options;
    probing.size = options.probe;
    IVec2 probeSize = chosenSize(probing);
    if (probeSize.x * probeSize.y > size.x * size.y) probeSize = size;
    if (options.samples < 128 || options.samples > kMaxSamples) throw InputError("--spp " + std::to_string(options.samples), "must be 128 .. 2^24");
    // Fails now rather than after minutes.
    if (!options.output.empty()) {
        const OutputFolder writable(std::filesystem::absolute(options.output).parent_path().string());
    }

    const ThreadLimit threads(options.threads);
    SceneCase sceneCase;
    sceneCase.scene = loadChosenScene(options);
    sceneCase.name = std::filesystem::path(options.scene.empty() ? options.view : options.scene).stem().string();
    sceneCase.camera = chosenCamera(sceneCase.scene, options);
    sceneCase.sceneSha256 = hashScene(sceneCase.scene);

    Progress progress(options.quiet);
    std::vector<TunePoint> points = chosenPoints(options, sceneCase.scene, sceneCase.camera, size);
    const Calibration calibration;
    TuneRequest request{.budget = budget, .width = size.x, .height = size.y, .threads = threadsOf(options)};
    // Short frames find a quiet moment where long ones do not.
    for (int i = 0; i < kCalibrationRuns; ++i) {
        const Calibration::Times times = calibration.run();
        request.before.calibrationCpu = std::min(request.before.calibrationCpu, times.cpu);
        if (times.cpu > 0.0) request.before.wallPerCpu = std::min(request.before.wallPerCpu, times.wall / times.cpu);
    }

    // The truth at both sizes; that of the asked one once a point is worth verifying.
    const auto truthAt = [&](const IVec2& at, std::uint64_t samples) {
        sceneCase.width = at.x;
        sceneCase.height = at.y;
        return SizedCase(sceneCase, at, findOrMakeTruth(sceneCase, samples, options.references, progress).value());
    };
    SizedCase small = truthAt(probeSize, options.samples);
    refuseBelowNoise(budget, small.figures(), small.samples());
    std::unique_ptr<SizedCase> asked;

    int probed = 0;
    const auto shown = [&](const std::string& what) {
        return MeasureOptions{.repeat = 1, .progress = [&progress, what](double fraction) { progress.show(what, fraction); }};
    };
    Measurement last;
    const TuneActions actions = {
        [&](const NamedSettings& named) {
            ++probed;
            return last = small.measure(named, calibration,
                                        shown("probing " + named.label + " (" + std::to_string(probed) + " of at most " + std::to_string(points.size()) + ")"));
        },
        [&](const NamedSettings& named) {
            if (!asked) asked = std::make_unique<SizedCase>(truthAt(size, verifyingSamples(budget, last, options.samples, small.samples())));
            return asked->measure(named, calibration, shown("verifying " + named.label));
        }};
    const TuneResult result = tune(points, request, actions);
    progress.clear();

    // The file holds every setting, so that it means the same over any preset.
    const TuneRecord record{.scene = sceneCase.name,
                            .request = request,
                            .result = result,
                            .probeSize = probeSize,
                            .probeNoise = small.figures().noise,
                            .probeSamples = small.samples(),
                            .verifyNoise = asked ? asked->figures().noise : 0.0,
                            .verifySamples = asked ? asked->samples() : 0};
    const std::optional<std::size_t> written = result.chosen ? result.chosen : options.nearest ? result.nearest : std::nullopt;
    const std::string text = jsonText(tuneJson(record, written));
    if (written && !options.output.empty()) writeFileWhole(options.output, std::as_bytes(std::span(text)));
    if (options.json)
        std::cout << text;
    else if (!options.quiet)
        printTune(std::cout, record, written ? options.output : "");
    return result.chosen ? 0 : 1;
}

}  // namespace

Command addTune(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("tune", "Choose settings for a scene: an error, a time, a memory; predicted, then verified");
    const auto options = std::make_shared<TuneArguments>();
    options->size = "640x360";
    addSceneOptions(*parser, *options);
    parser->add_option("-o,--output", options->output, "settings file for render --settings; written when a setting meets the budget");
    const CLI::Option* error =
        parser->add_option("--max-error", options->maxError, "of the metric, on the irradiance; the cheapest settings that meet it are taken");
    parser->add_option("--max-time", options->maxTime, "of a frame: 40 or 40ms on this machine when quiet; 3.5cal: calibration frames, for any machine");
    const CLI::Option* memory = parser->add_option("--max-memory", options->maxMemory, "MB of 10^6 bytes, as in render --max-memory");
    parser->add_option("--metric", options->metric, "rmse (over the mean, without the truth's noise), flip, or energy (its distance from 1)")
        ->capture_default_str();
    parser->add_option("--set", options->assignments, "key=value kept in every settings tried; repeatable")->allow_extra_args(false);
    addPictureOptions(*parser, *options);
    parser->add_option("--probe", options->probe, "WxH at which settings are tried")->capture_default_str();
    parser->add_option("--spp", options->samples, "samples a pixel of the path-traced truth")->capture_default_str();
    parser->add_option("--references", options->references, "folder of references, as lrsm reference and lrsm sweep write them: read, and added to");
    parser->add_flag("--nearest", options->nearest, "write the nearest settings where none meet the budget (the exit code is 1 all the same)");
    parser->add_flag("--untrimmed", options->untrimmed, "leave in what the scene does not require");
    addRunOptions(*parser, *options);
    parser->footer("Without --max-error: the smallest error within time and memory. Exit code 1: no settings meet the budget. See docs/tune.md.");
    return {parser, [options, error, memory] {
                options->hasError = error->count() > 0;
                options->hasMemory = memory->count() > 0;
                return runTune(*options);
            }};
}

}  // namespace lrsm
