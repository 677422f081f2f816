#include "apps/capture/capture_files.h"
#include "apps/capture/passes.h"
#include "apps/capture/pictures.h"
#include "apps/capture/record.h"
#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/common/earlier_result.h"
#include "apps/common/memory.h"
#include "apps/common/messages.h"
#include "apps/common/progress.h"
#include "apps/common/sequence.h"
#include "conetrace/lrsm/memory.h"
#include "conetrace/render.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

struct Options : CommonOptions {
    SequenceArguments sequence;
    std::string output;
    std::vector<std::string> only;
    bool noDds = false, noPictures = false;
};

/// The nearest folder that exists: where the disk's free space is asked.
std::uintmax_t freeBytes(std::filesystem::path path)
{
    std::error_code error;
    while (!std::filesystem::exists(path, error) && path.has_relative_path()) path = path.parent_path();
    const std::filesystem::space_info space = std::filesystem::space(path, error);
    return error ? std::numeric_limits<std::uintmax_t>::max() : space.available;
}

void refuseFullDisk(const OutputFolder& folder, std::size_t bytes)
{
    const std::uintmax_t available = freeBytes(folder.path());
    if (bytes > available)
        throw MachineError(folder.path().string(), "this capture needs " + megabytes(bytes) + ", the disk has " + megabytes(available) +
                                                       "; leave out --only passes, use --no-dds, or lower --size or the resolutions");
}

void printSummary(const Capture& capture, std::size_t bytes, const std::string& where)
{
    for (const CapturedPass& pass : capture.passes) {
        std::size_t held = 0, count = 0;
        for (const Buffer& buffer : capture.buffers)
            if (buffer.pass == pass.name) {
                held += buffer.bytes.size();
                ++count;
            }
        std::cout << "  " << std::left << std::setw(12) << pass.name << std::right << std::setw(4) << count << " buffers" << std::setw(13) << megabytes(held)
                  << "\n";
    }
    std::cout << where << ": " << capture.buffers.size() << " buffers, " << megabytes(bytes) << " with their textures; manifest.json says what is what\n";
}

/// Exact shadows need the scene's triangles, which a candidate's pass has not, and the wider filter passes are not the paper's: a golden capture compares
/// with the RSM's depth and ends with the 4x4 filter, unless told otherwise.
Settings capturedSettings(const Options& options)
{
    Settings settings = chosenSettings(options);
    const auto chosen = [&](const char* assignment) {
        return !options.settingsFile.empty() ||
               std::any_of(options.assignments.begin(), options.assignments.end(), [&](const std::string& text) { return text.starts_with(assignment); });
    };
    if (settings.method == Method::lrsm && settings.cones.march.visibility != Visibility::cones)
        throw InputError("capture", "holds the cones' passes alone; take visibility=cones");
    if (settings.voxel.cascades != 1) throw InputError("capture", "holds the voxels of one grid; take voxel_cascades=1");
    if (settings.cones.set.gatherDivisor != 1 && methodOf(settings).pixelByPixel)
        throw InputError("capture", "holds the passes of all pixels; take gather_divisor=1");
    if (settings.method == Method::proxies && settings.proxies.gatherDivisor != 1) {
        if (chosen("pp_gather_divisor=")) throw InputError("capture", "holds the passes of all pixels; take pp_gather_divisor=1");
        settings.proxies.gatherDivisor = 1;
    }
    if (!chosen("filter_passes=")) settings.cones.set.filterPasses = 0;
    if (settings.direct.shadows == Shadows::exact && !chosen("shadows=")) settings.direct.shadows = Shadows::hard;
    return settings;
}

struct Captured {
    std::size_t predictedBytes = 0;
    Capture capture;
};

/// One capture to its files, which are not committed.
Captured captureTo(OutputFolder& folder, const Options& options, const Settings& settings, const Scene& scene, const Camera& camera, SayOnce& sayOnce)
{
    const IVec2 size = chosenSize(options);
    const Requirements needs = analyseRequirements(scene, settings.force);
    Progress progress(options.quiet);
    RecordOptions record;
    record.width = size.x, record.height = size.y;
    record.only = options.only;
    record.dds = !options.noDds;
    record.progress = [&](const std::string& pass, double fraction) { progress.show(pass, fraction); };
    record.finished = [&](const Frame& frame) {
        progress.clear();
        sayOnce(passMessages(frame.passes));
        sayOnce(darknessMessages(scene, {frame.gbuffer.position, frame.gbuffer.geometricNormal, frame.gbuffer.depthLinear}, frame.direct, frame.combined));
    };
    sayOnce(loadMessages(scene, options.verbose));
    sayOnce(extentMessages(scene, camera, settings));
    Captured captured;
    captured.predictedBytes = predictCaptureBytes(chosenBuffers(scene, needs, settings, record, layersKept({scene, needs, settings, size.x, size.y})));
    refuseFullDisk(folder, captured.predictedBytes);
    if (!options.quiet && !options.json) std::cout << "buffers and textures: " << megabytes(captured.predictedBytes) << std::endl;

    captured.capture = recordCapture(scene, camera, needs, settings, record, LRSM_VERSION);
    progress.show("writing", 0.0);
    writeCapture(folder, captured.capture);
    if (!options.noPictures) writePictures(folder, captured.capture);
    progress.clear();
    return captured;
}

/// All that an earlier capture wrote goes: a verdict must never rest on buffers of two.
std::vector<std::string> earlierCapture(const std::filesystem::path& folder)
{
    std::vector<std::string> files = filesOfCapture(folder.string());
    if (files.empty()) return {};
    const std::vector<std::string> pictures = pictureFiles(files);
    files.insert(files.end(), pictures.begin(), pictures.end());
    return files;
}

int captureFrames(const Options& options, const Settings& settings, const FrameRange& range)
{
    const IVec2 size = chosenSize(options);
    SayOnce sayOnce;
    return runSequence({.range = range,
                        .folder = options.output,
                        .common = {{"command", "capture"},
                                   {"size", {size.x, size.y}},
                                   {"only", options.only},
                                   {"dds", !options.noDds},
                                   {"pictures", !options.noPictures},
                                   {"preset", options.preset},
                                   {"settings", settingsToJson(settings)}},
                        .mainFile = kManifestFile,
                        .quiet = options.quiet,
                        .json = options.json,
                        .make =
                            [&](const SequenceFrame& frame, OutputFolder& folder) {
                                captureTo(folder, options, settings, frame.scene, frame.camera, sayOnce);
                                return true;
                            },
                        .earlier = earlierCapture},
                       options);
}

int run(const Options& options)
{
    if (options.output.empty()) throw InputError("capture", "needs -o FOLDER");
    const Settings settings = capturedSettings(options);
    chosenSize(options);
    const ThreadLimit threads(options.threads);
    refuseOtherResult(options.output, "capture");
    if (const std::optional<FrameRange> range = chosenFrames(options.sequence)) return captureFrames(options, settings, *range);

    OutputFolder folder(options.output);
    const Scene scene = loadChosenScene(options);
    SayOnce sayOnce;
    const Captured captured = captureTo(folder, options, settings, scene, chosenCamera(scene, options), sayOnce);
    folder.commit(earlierCapture);

    const std::size_t bytes = predictCaptureBytes(captured.capture.buffers);
    if (options.json)
        std::cout << jsonText(
            {{"folder", options.output}, {"predicted_bytes", captured.predictedBytes}, {"bytes", bytes}, {"buffers", captured.capture.buffers.size()}});
    else if (!options.quiet)
        printSummary(captured.capture, bytes, folder.path().string());
    return 0;
}

}  // namespace

Command addCapture(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand(
        "capture", "Write every pass's output, bit for bit, to hold another implementation against (docs/capture.md); shadows=hard unless chosen");
    const auto options = std::make_shared<Options>();
    addSceneOptions(*parser, *options);
    addSettingOptions(*parser, *options);
    addPictureOptions(*parser, *options);
    addRunOptions(*parser, *options);
    addSequenceOptions(*parser, options->sequence);
    parser->add_option("-o,--output", options->output, "folder for the capture; it appears whole or not at all");
    parser->add_option("--only", options->only, "passes whose buffers are kept: " + passNames())
        ->check(passNameError, "")
        ->delimiter(',')
        ->allow_extra_args(false);
    parser->add_flag("--no-dds", options->noDds, "leave out the DDS files");
    parser->add_flag("--no-pictures", options->noPictures, "leave out the EXR files and the contact sheet");
    return {parser, [options] { return run(*options); }};
}

}  // namespace lrsm
