#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/interrupts.h"
#include "apps/sweep/cases.h"
#include "apps/sweep/operating_points.h"
#include "apps/sweep/search.h"
#include "apps/sweep/sweep_report.h"
#include "apps/sweep/sweep_run.h"
#include "apps/sweep/truth.h"
#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/base/output_folder.h"
#include "core/base/parallel.h"
#include "core/report/table.h"
#include "core/scene/scene_hash.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

namespace fs = std::filesystem;

struct SweepArguments : CommonOptions {
    std::vector<std::string> scenes;
    std::string output, axesFile, references, part;
    std::vector<std::string> axes;
    std::uint64_t samples = 1024, pathTracerSamples = 1024, seed = 0;
    int repeat = 3, budget = 100;
    double maxMemoryMegabytes = 0.0;
    bool reportOnly = false;
};

enum class Plan { presets, points, oneAtATime, product, search };

Plan chosenPlan(const SweepArguments& options)
{
    if (options.axesFile == "presets") return Plan::presets;
    if (options.axesFile == "points") return Plan::points;
    if (options.axesFile == "search") return Plan::search;
    if (options.axesFile == "one-at-a-time" || (options.axesFile.empty() && options.axes.empty())) return Plan::oneAtATime;
    return Plan::product;
}

/// Of --part I/K: every K-th row of the plan, from the I-th on.
struct Part {
    std::size_t index = 0, count = 1;
    bool holds(std::size_t row) const { return row % count == index; }
};
Part chosenPart(const SweepArguments& options, Plan plan)
{
    Part part;
    if (options.part.empty()) return part;
    constexpr std::size_t kMost = 1000000;
    char end = 0;
    if (std::sscanf(options.part.c_str(), "%zu/%zu%c", &part.index, &part.count, &end) != 2 || part.count > kMost || part.index >= part.count)
        throw InputError("--part " + options.part, "must be I/K with I = 0 .. K-1: one of K parts of the rows");
    if (plan == Plan::search) throw InputError("--part " + options.part, "cannot part --axes search, whose rows are not known beforehand");
    return part;
}

/// Settings beside the presets; the search's are not known beforehand.
std::vector<NamedSettings> plannedSettings(const SweepArguments& options, Plan plan, const Settings& base)
{
    if (plan != Plan::product && !options.axes.empty())
        throw InputError("--axis " + options.axes.front(), "goes with --axes FILE, or alone; not with --axes " + options.axesFile);
    std::vector<std::string> refused;
    std::vector<NamedSettings> all;
    if (plan == Plan::points) all = operatingPoints();
    if (plan == Plan::oneAtATime) all = oneAtATime(base, &refused);
    if (plan == Plan::product) {
        std::vector<Axis> axes;
        if (!options.axesFile.empty()) axes = readAxes(options.axesFile);
        for (const std::string& text : options.axes) axes.push_back(parseAxis(text));
        all = combine(base, axes, &refused);
    }
    if (!options.quiet)
        for (const std::string& line : refused) std::cerr << "lrsm: left out " << line << std::endl;
    return all;
}

/// Nothing is written: what is wrong with a scene shows before the folder is made.
std::vector<SweptCase> loadCases(const SweepArguments& options)
{
    const IVec2 size = chosenSize(options);
    Progress progress(options.quiet);
    std::vector<SweptCase> cases;
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) scenes.emplace_back();  // the view file's own
    for (const std::string& scene : scenes) {
        CommonOptions one = options;
        one.scene = scene;
        SceneCase& sceneCase = cases.emplace_back().scene;
        progress.show("loading " + scene, 0.0);
        sceneCase.scene = loadChosenScene(one);
        sceneCase.name = fs::path(scene.empty() ? options.view : scene).stem().string() + (options.camera.empty() ? "" : ":" + options.camera);
        sceneCase.camera = chosenCamera(sceneCase.scene, one);
        sceneCase.sceneSha256 = hashScene(sceneCase.scene);
        sceneCase.width = size.x;
        sceneCase.height = size.y;
    }
    return cases;
}

/// False when stopped.
bool addTruths(const SweepArguments& options, std::vector<SweptCase>& cases, const std::atomic<bool>& stop)
{
    const std::string references = options.references.empty() ? (fs::path(options.output) / "references").string() : options.references;
    Progress progress(options.quiet);
    for (SweptCase& one : cases) {
        std::optional<Truth> truth = findOrMakeTruth(one.scene, options.samples, references, progress, &stop);
        progress.clear();
        if (!truth) return false;
        one.scene.truth = std::move(*truth);
        one.figures = figuresOf(one.scene.truth);
        one.key = caseKeyOf(one.scene);
        if (!options.quiet)
            std::cerr << one.scene.name << ": truth of " << one.scene.truth.samples << " paths a pixel, its own noise " << shortNumber(one.figures.noise)
                      << " (RMSE / mean): nothing is claimed below a quarter of it" << std::endl;
    }
    return true;
}

/// False when stopped.
bool runTasks(SweepRun& run, const std::vector<SweepTask>& tasks)
{
    for (const SweepTask& task : tasks) {
        run.measure(task);
        if (run.stopped()) return false;
    }
    return true;
}

/// False when stopped.
bool runSearch(const SweepArguments& options, const Settings& base, SweepRun& run, const std::vector<SweptCase>& cases)
{
    std::vector<Measurement> baselines;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Measurement* row = run.measure({i, {"balanced", preset("balanced")}, RowKind::preset, ""});
        if (!row) throw InputError("--axes search", "needs the preset balanced on every scene, and " + cases[i].scene.name + " cannot be rendered with it");
        baselines.push_back(*row);
    }
    SearchOptions search;
    search.budget = options.budget;
    search.seed = options.seed;
    search.sceneCount = cases.size();
    for (const std::string& name : presetNames()) search.start.push_back({name, preset(name)});
    search.stop = [&] { return run.stopped(); };
    search.progress = [&, last = 0](int visited, int) mutable {
        if (visited > last) run.expect(cases.size());
        last = visited;
    };
    search.evaluate = [&](const NamedSettings& named, std::size_t scene) -> std::optional<CostError> {
        const Measurement* row = run.measure({scene, named, RowKind::search, ""});
        if (row) return relativeTo(*row, baselines[scene]);
        if (run.stopped()) return {};
        return CostError{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    };
    const SearchResult result = runFrontSearch(base, searchAxes(), search);
    if (!options.quiet) std::cerr << describeSearch(result) << std::endl;
    return !result.stopped;
}

void printFronts(const std::vector<Measurement>& rows)
{
    for (const CaseRows& one : casesOf(rows)) {
        if (one.settings.empty()) continue;
        ReportTable table{"", {"settings", "cost", "frame ms", "MB", "net RMSE / mean", "energy", "FLIP"}, {}};
        for (const Measurement* row : timeFront(one))
            table.rows.push_back({row->label, shortNumber(row->cost), shortNumber(row->frame.median), shortNumber(double(row->bytes) * 1e-6),
                                  shortNumber(row->error.net()), shortNumber(row->error.energy), shortNumber(row->error.flip)});
        const Measurement& any = *one.settings.front();
        std::cout << any.scene << ", " << any.width << "x" << any.height << ": " << table.rows.size() << " of " << one.settings.size()
                  << " settings on the front of cost (in calibration frames) against error\n"
                  << textTable(table) << "\n";
    }
}

void finishFolder(const RowStore& store, const std::string& folder)
{
    store.writeTables();
    const auto write = [&](const char* name, const std::string& text) { writeFileWhole((fs::path(folder) / name).string(), std::as_bytes(std::span(text))); };
    write("report.html", sweepReportHtml(store.rows(), folder));
    write("tables.md", sweepTablesMarkdown(store.rows()));
}

void sayWhatWasFound(const RowStore& store, const SweepArguments& options)
{
    if (options.quiet) return;
    if (store.droppedTornLine()) std::cerr << "lrsm: " << options.output << ": the last row was cut off and is measured again" << std::endl;
    if (store.rowsOfOtherVersions() > 0)
        std::cerr << "lrsm: " << options.output << ": " << store.rowsOfOtherVersions() << " rows of another version of this program are kept and not used"
                  << std::endl;
}

std::vector<SweepTask> tasksOf(const std::vector<NamedSettings>& settings, std::size_t cases, RowKind kind, const std::string& base)
{
    std::vector<SweepTask> tasks;
    for (std::size_t i = 0; i < cases; ++i)
        for (const NamedSettings& named : settings) tasks.push_back({i, named, kind, base});
    return tasks;
}

/// Presets, then the path tracer, then the rest. False when stopped.
bool runAll(const SweepArguments& options, Plan plan, const Part& part, const std::vector<NamedSettings>& settings, const Settings& base, SweepRun& run,
            const std::vector<SweptCase>& cases)
{
    std::vector<NamedSettings> presets;
    for (const std::string& name : presetNames()) presets.push_back({name, preset(name)});
    std::size_t row = 0;
    const auto ofThisPart = [&](std::vector<SweepTask> tasks) {
        std::erase_if(tasks, [&](const SweepTask&) { return !part.holds(row++); });
        return tasks;
    };
    const std::vector<SweepTask> first = ofThisPart(tasksOf(presets, cases.size(), RowKind::preset, ""));
    const bool pure = plan != Plan::points && base == preset(options.preset);
    // The path tracer's rows of a case come from one run: one row of the plan.
    std::vector<std::size_t> tracedCases;
    for (std::size_t i = 0; i < cases.size() && options.pathTracerSamples > 0; ++i)
        if (part.holds(row++)) tracedCases.push_back(i);
    const std::vector<SweepTask> rest = ofThisPart(tasksOf(settings, cases.size(), RowKind::axis, pure ? options.preset : ""));
    std::size_t traced = 0;
    for (std::uint64_t n = 1, before = 0; before < options.pathTracerSamples; before = n, n = std::min(2 * n, options.pathTracerSamples)) ++traced;
    run.expect(first.size() + traced * tracedCases.size() + rest.size());

    if (!runTasks(run, first)) return false;
    for (const std::size_t i : tracedCases)
        if (!run.measurePathTracer(i, options.pathTracerSamples)) return false;
    if (!runTasks(run, rest)) return false;
    return plan != Plan::search || runSearch(options, base, run, cases);
}

int runSweep(const SweepArguments& options)
{
    if (options.output.empty()) throw InputError("sweep", "needs -o FOLDER");
    const Plan plan = chosenPlan(options);
    const Part part = chosenPart(options, plan);
    const Settings base = chosenSettings(options);
    if (options.repeat < 1 || options.repeat > 1000) throw InputError("--repeat " + std::to_string(options.repeat), "must be 1 .. 1000");
    if (!(options.maxMemoryMegabytes >= 0.0)) throw InputError("--max-memory", "must be 0 (no limit) or more");
    if (options.pathTracerSamples > std::uint64_t(1) << 24) throw InputError("--path-tracer", "must be 0 (none) .. 2^24");
    const std::vector<NamedSettings> settings = options.reportOnly ? std::vector<NamedSettings>() : plannedSettings(options, plan, base);
    if (!options.reportOnly && options.scenes.empty() && options.view.empty()) throw InputError("sweep", "needs at least one SCENE");

    if (options.reportOnly && !fs::is_regular_file(fs::path(options.output) / "rows.jsonl"))
        throw InputError(options.output, "holds no rows.jsonl; sweep first");
    {
        const OutputFolder writable(options.output);
    }
    const ThreadLimit threads(options.threads);
    std::vector<SweptCase> cases = options.reportOnly ? std::vector<SweptCase>() : loadCases(options);
    RowStore store(options.output);
    sayWhatWasFound(store, options);
    if (options.reportOnly) {
        finishFolder(store, options.output);
        return 0;
    }

    const CatchInterrupts catching;
    bool complete = addTruths(options, cases, catching.asked());
    std::size_t measured = 0, found = 0, skipped = 0;
    if (complete) {
        SweepRun run(cases, store,
                     {.folder = options.output,
                      .repeat = options.repeat,
                      .maxMemoryMegabytes = options.maxMemoryMegabytes,
                      .quiet = options.quiet,
                      .stop = &catching.asked()});
        complete = runAll(options, plan, part, settings, base, run, cases);
        measured = run.measured();
        found = run.found();
        skipped = run.skipped().size();
    }
    finishFolder(store, options.output);
    if (!complete) {
        std::cerr << "lrsm: interrupted; " << store.rows().size() << " rows are in " << options.output << " (the same command goes on from there)" << std::endl;
        return kInterruptedCode;
    }
    if (options.json) {
        const std::vector<unsigned char> text = readFile((fs::path(options.output) / "sweep.json").string());
        std::cout.write(reinterpret_cast<const char*>(text.data()), std::streamsize(text.size()));
    } else if (!options.quiet) {
        printFronts(store.rows());
        std::cout << options.output << ": " << measured << " rows measured, " << found << " found, " << skipped
                  << " skipped; rows.jsonl, sweep.csv, sweep.json, report.html, tables.md, thumbnails\n";
    }
    return 0;
}

}  // namespace

Command addSweep(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("sweep", "Measure speed, memory and accuracy over settings, against the path tracer");
    const auto options = std::make_shared<SweepArguments>();
    options->size = "320x180";
    addScenesOptions(*parser, *options, options->scenes);
    addSettingOptions(*parser, *options);
    addPictureOptions(*parser, *options);
    addRunOptions(*parser, *options);
    parser->add_option("-o,--output", options->output, "folder for the rows; the same command goes on where it was interrupted");
    parser->add_option("--axes", options->axesFile,
                       "one-at-a-time (around the settings given), presets, points (what lrsm tune chooses among), search (for the front), or a JSON file "
                       "{\"key\": [values], ...}: every combination");
    parser->add_option("--axis", options->axes, "key=v1,v2,...: every combination with the others; repeatable")->allow_extra_args(false);
    parser->add_option("--repeat", options->repeat, "frames timed for each row")->capture_default_str();
    parser->add_option("--spp", options->samples, "paths a pixel of the truth, at least")->capture_default_str();
    parser->add_option("--references", options->references, "folder of references, as lrsm reference writes them: read, and added to (FOLDER/references)");
    parser->add_option("--path-tracer", options->pathTracerSamples, "also the path tracer at 1, 2, 4 ... this many paths a pixel; 0: not")
        ->capture_default_str();
    parser->add_option("--budget", options->budget, "settings that the search visits")->capture_default_str();
    parser->add_option("--seed", options->seed, "of the search's random choices")->capture_default_str();
    parser->add_option("--max-memory", options->maxMemoryMegabytes, "MB of 10^6 bytes; settings that need more are skipped");
    parser->add_option("--part", options->part,
                       "I/K: only every K-th row, from the I-th on, so that K machines share the work (docs/cluster.md); not with --axes search");
    parser->add_flag("--report-only", options->reportOnly, "make report.html, tables.md, sweep.csv and sweep.json again from the rows");
    parser->footer("The presets are measured in any case. See docs/file-formats.md for the columns.");
    return {parser, [options] { return runSweep(*options); }};
}

}  // namespace lrsm
