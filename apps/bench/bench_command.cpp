#include "apps/bench/bench_report.h"
#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/common/interrupts.h"
#include "apps/common/progress.h"
#include "core/base/errors.h"
#include "core/base/output_folder.h"
#include "core/base/text.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

namespace lrsm {
namespace {

struct BenchArguments : CommonOptions {
    std::vector<std::string> axes;
    std::string output;
    int repeat = 3, cores = 0;
    bool quick = false;
};

ScalingBase chosenBase(const BenchArguments& options)
{
    ScalingBase base;
    base.scene = loadChosenScene(options);
    base.camera = chosenCamera(base.scene, options);
    base.settings = preset(options.preset);
    if (!options.settingsFile.empty()) applySettingsFile(base.settings, options.settingsFile);
    base.assignments = options.assignments;
    if (!options.size.empty()) base.size = chosenSize(options);
    base.quick = options.quick;
    base.threads = options.threads;
    base.cores = options.cores > 0 ? options.cores : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return base;
}

/// What is misspelt must not show after minutes.
void refuseEarly(const ScalingBase& base, const std::vector<std::string>& names)
{
    Settings settings = base.settings;
    for (const std::string& assignment : base.assignments) applySetting(settings, assignment);
    validate(settings);
    for (const std::string& name : names)
        if (std::find(scalingAxisNames().begin(), scalingAxisNames().end(), name) == scalingAxisNames().end()) makeScalingAxis(name, base);
}

/// Says how long the rest of an axis takes, by the frames so far.
class TimeLeft {
  public:
    std::string at(double fraction) const
    {
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
        if (fraction <= 0.0) return "";
        return ", " + std::to_string(static_cast<int>(spent.count() * (1.0 - fraction) / fraction + 0.5)) + " s left of this axis";
    }

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

void printAxis(const MeasuredAxis& measured)
{
    std::cout << "\n" << textTable(pointTable(measured));
    for (const std::string& note : measured.leftOut) std::cout << "left out: " << note << "\n";
    std::cout.flush();
}

int runBench(const BenchArguments& options)
{
    const std::vector<std::string> names = options.axes.empty() ? scalingAxisNames() : options.axes;
    const ScalingBase base = chosenBase(options);
    refuseEarly(base, names);
    {
        OutputFolder probe(options.output);
    }
    std::filesystem::create_directories(options.output);
    const auto write = [&](const char* name, const std::string& text) { writeFileWhole(options.output + "/" + name, std::as_bytes(std::span(text))); };
    std::vector<BenchRow> rows;
    const nlohmann::ordered_json machine = machineJson();
    Progress progress(options.quiet);
    std::vector<MeasuredAxis> measured;
    const CatchInterrupts catching;
    for (const std::string& name : names) {
        progress.show(name, 0.0);
        ScalingAxis axis = makeScalingAxis(name, base);
        const TimeLeft left;
        // Rows as they come, so that an interrupted run leaves what it measured.
        const auto keep = [&](const ScalingSample& sample) {
            rows.push_back(benchRow(axis, sample));
            write("bench.csv", csvTable(benchTable(rows)));
        };
        const ScalingWatch watch = {keep, [&](const std::string& what, double fraction) { progress.show(what + left.at(fraction), fraction); },
                                    [&] { return catching.asked().load(); }};
        const ScalingRun run = runScaling(axis, options.repeat, watch);
        ScalingResult result = summarizeScaling(axis, run.samples);
        for (ScalingPoint& point : axis.points) point.scene.reset();  // millions of triangles
        measured.push_back({std::move(axis), std::move(result), run.leftOut});
        progress.clear();
        write("bench.json", jsonText(benchJson(measured, machine, options.repeat)));
        write("bench.html", benchPage(measured, machine, options.repeat));
        if (!options.quiet && !options.json) printAxis(measured.back());
        if (catching.asked()) {
            std::cerr << "lrsm: interrupted; what was measured is in " << options.output << std::endl;
            return kInterruptedCode;
        }
    }
    if (options.json)
        std::cout << jsonText(benchJson(measured, machine, options.repeat));
    else if (!options.quiet)
        std::cout << "\n" << options.output << ": bench.csv, bench.json, bench.html\n";
    return 0;
}

}  // namespace

Command addBench(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("bench", "How cost grows with pixels, cones, layers, lights, resolutions, triangles, threads");
    const auto options = std::make_shared<BenchArguments>();
    options->size.clear();
    options->scene = "atrium";
    parser->add_option("AXIS", options->axes, "what grows, in this order; all without: " + joined(scalingAxisNames()));
    parser->add_option("-o,--output", options->output, "folder for bench.csv (a line a frame, as they come), bench.json and bench.html (after each axis)")
        ->required();
    parser->add_option("--scene", options->scene, "a .gltf, .glb or view .json file, or a built-in scene (lrsm info --list)")->capture_default_str();
    parser->add_option("--camera", options->camera, "camera by name or index");
    parser->add_option("--size", options->size, "WxH of every axis, the largest of `pixels`; without: each axis its own");
    addSettingOptions(*parser, *options);
    addRunOptions(*parser, *options);
    parser->add_option("--repeat", options->repeat, "frames a point, round robin over the axis; medians are shown")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    parser->add_option("--cores", options->cores, "the most that axis `threads` takes; 0: all the machine has")->check(CLI::Range(0, 1024));
    parser->add_flag("--quick", options->quick, "tiny frames, three values an axis: to see that it works, not to measure");
    parser->footer(
        "Each axis lowers voxel and RSM resolution so that what grows can be seen; --set goes over that. Times are processor time of all threads (_cpu_ms) and "
        "wall time (_ms).");
    return {parser, [options] { return runBench(*options); }};
}

}  // namespace lrsm
