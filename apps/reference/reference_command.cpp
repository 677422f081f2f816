#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/common/earlier_result.h"
#include "apps/common/interrupts.h"
#include "apps/common/messages.h"
#include "apps/common/progress.h"
#include "apps/common/sequence.h"
#include "apps/reference/reference_files.h"
#include "apps/reference/reference_run.h"
#include "core/base/errors.h"
#include "core/base/file.h"
#include "core/base/parallel.h"
#include "core/report/table.h"
#include "core/scene/scene_hash.h"

#include <atomic>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

struct ReferenceArguments : CommonOptions {
    SequenceArguments sequence;
    std::string output, samples, model = "single", exposure = "auto";
    std::uint64_t spp = 256, seed = 0;
    int block = 16;
    float specularAperture = 0.0f;
    double targetNoise = 0.0;
    double checkpointSeconds = 60.0;
    bool resume = false, bareLoop = false, eyeSide = false;
};

ReferenceSettings chosenReference(const ReferenceArguments& options)
{
    ReferenceSettings settings;
    const IVec2 size = chosenSize(options);
    settings.width = size.x;
    settings.height = size.y;
    if (options.model != "single" && options.model != "full") throw InputError("--model " + options.model, "must be single or full");
    settings.transport = options.model == "full" ? Transport::full : Transport::single;
    settings.blockBits = 0;
    while ((1 << settings.blockBits) < options.block) ++settings.blockBits;
    if ((1 << settings.blockBits) != options.block) throw InputError("--block " + std::to_string(options.block), "must be a power of two, 1 .. 4096");
    settings.specularApertureDegrees = options.specularAperture;
    settings.seed = options.seed;
    settings.fromLights = !options.eyeSide;
    validate(settings);
    return settings;
}

SampleRange chosenRange(const ReferenceArguments& options)
{
    if (!options.samples.empty()) return parseSamples(options.samples);
    if (options.targetNoise != 0.0) return {0, std::uint64_t(options.block)};  // a first block; the noise says how many more
    if (options.spp < 1 || options.spp > std::uint64_t(1) << 32) throw InputError("--spp " + std::to_string(options.spp), "must be 1 .. 2^32");
    return {0, options.spp};
}

/// Samples can be added to the end of what is there. `open`: the range has no end yet.
void requireBeginning(const ReferenceState& state, const SampleRange& range, bool open, const std::string& place)
{
    std::vector<SampleRange> there = state.finished() ? state.sums.ranges : state.base.ranges;
    if (!state.finished()) there.push_back(state.target);
    if (there.front().begin != range.begin || (!open && there.back().end > range.end))
        throw InputError(place,
                         "holds samples " + describeRanges(there) + "; --resume can add to their end, but " + describeRanges({range}) + " was asked for");
}

/// The samples already in the folder, if there are any to go on from.
std::optional<Checkpoint> earlierSamples(const std::string& folder, bool resume, bool toNoise, const Identity& identity, const SampleRange& range)
{
    const std::filesystem::path file = std::filesystem::path(folder) / kSamplesFile;
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return {};
    if (!resume) {
        // Never throw hours away by a forgotten option; finished pictures may be replaced, as render does.
        Checkpoint found;
        try {
            found = decodeCheckpoint(readFile(file.string()), file.string());
        } catch (const InputError&) {
            return {};
        }
        if (!found.state.finished()) throw InputError(folder, "holds an unfinished render; --resume continues it, or delete " + file.string());
        return {};
    }
    Checkpoint found = decodeCheckpoint(readFile(file.string()), file.string());
    requireSameIdentity(identity, "this run", found.identity, file.string());
    requireBeginning(found.state, range, toNoise, folder);
    return found;
}

void saySeen(const Scene& scene, const PrimaryHits& seen, const ReferenceFrame& picture, const SampleFaults& faults, SayOnce& sayOnce)
{
    if (faults.notFinite > 0) sayOnce({std::to_string(faults.notFinite) + " values were not finite and count as 0"});
    if (faults.clamped > 0)
        sayOnce({std::to_string(faults.clamped) + " values of paths were above 2^24 times the scene's unit of radiance and count as that: the picture is too "
                                                  "dark where a path finds something that bright"});
    Image<Vec3> position(seen.depth.width, seen.depth.height), normal = position;
    for (std::size_t i = 0; i < position.texels.size(); ++i) {
        position.texels[i] = seen.surface.texels[i].position;
        normal.texels[i] = seen.surface.texels[i].geometricNormal;
    }
    sayOnce(darknessMessages(scene, {position, normal, seen.depth}, seen.direct, picture.combined));
}

/// What a picture is traced with, besides its scene.
struct ReferencePlan {
    const ReferenceArguments& arguments;
    ReferenceSettings settings;
    SampleRange range;
    std::optional<float> exposure;
};

ReferencePlan planReference(const ReferenceArguments& arguments)
{
    if (arguments.output.empty()) throw InputError("reference", "needs -o FOLDER");
    ReferencePlan plan{arguments, chosenReference(arguments), chosenRange(arguments), parseExposure(arguments.exposure)};
    if (arguments.targetNoise != 0.0 && !(arguments.targetNoise > 0.0 && arguments.targetNoise < 1.0))
        throw InputError("--target-noise " + std::to_string(arguments.targetNoise), "must be above 0 and below 1: RMSE / mean of the irradiance, as 0.01");
    if (!(arguments.checkpointSeconds >= 0.0)) throw InputError("--checkpoint-seconds", "must be 0 or more");
    return plan;
}

Json bareLoopJson(const PathTracer& tracer, double raysPerSecond)
{
    const BareLoop bare = tracer.timeBareLoop(std::max<std::size_t>(1, tracer.primary().covered.texels.size() / 65536));
    const double rate = bare.seconds > 0.0 ? double(bare.rays) / bare.seconds : 0.0;
    return {{"rays", bare.rays}, {"seconds", bare.seconds}, {"million_per_second", rate * 1e-6}, {"ratio", rate > 0.0 ? raysPerSecond / rate : 0.0}};
}

struct Traced {
    Json json;  ///< frame.json
    double noise = 0.0;
};

/// One picture, from what `path` holds already (with `resume`) to its files in `folder`, which are not committed; nothing when it was interrupted: `path` then
/// has what is done.
std::optional<Traced> traceTo(OutputFolder& folder, const ReferencePlan& plan, const Scene& scene, const Camera& camera, const std::string& sceneHash,
                              bool resume, const std::atomic<bool>& stop, SayOnce& sayOnce)
{
    const ReferenceArguments& arguments = plan.arguments;
    const std::string path = folder.path().string();
    sayOnce(loadMessages(scene, arguments.verbose));
    Progress progress(arguments.quiet);
    progress.show("building the BVH", 0.0);
    const PathTracer tracer(scene, camera, plan.settings);
    Checkpoint checkpoint{identifyReference(tracer, camera, sceneHash), tracer.unit(), {}};
    std::optional<Checkpoint> earlier = earlierSamples(path, resume, arguments.targetNoise != 0.0, checkpoint.identity, plan.range);

    const TraceOptions trace{.folder = path,
                             .checkpointSeconds = arguments.checkpointSeconds,
                             .show = [&](const std::string& text, double fraction) { progress.show(text, fraction); },
                             .stop = &stop};
    ReferenceState state = earlier ? std::move(earlier->state) : tracer.start(plan.range);
    const bool complete = arguments.targetNoise != 0.0 ? traceToNoise(tracer, state, arguments.targetNoise, checkpoint, trace)
                                                       : traceRange(tracer, state, plan.range, checkpoint, trace);
    progress.clear();
    if (!complete) return {};
    const double seconds = state.seconds;
    checkpoint.state = std::move(state);
    Traced traced{referenceJson(scene, sceneHash, camera, tracer, checkpoint.state), noiseOf(tracer, checkpoint.state.sums)};
    if (arguments.bareLoop) traced.json["bare_loop"] = bareLoopJson(tracer, seconds > 0.0 ? double(checkpoint.state.rays.total()) / seconds : 0.0);
    const ReferenceFrame picture = writeReference(folder, checkpoint, seenLayers(scene, tracer.primary()), traced.json, plan.exposure);
    saySeen(scene, tracer.primary(), picture, checkpoint.state.faults, sayOnce);
    return traced;
}

int traceFrames(const ReferencePlan& plan, const FrameRange& range)
{
    const ReferenceArguments& arguments = plan.arguments;
    SayOnce sayOnce;
    return runSequence(
        {.range = range,
         .folder = arguments.output,
         .common = {{"command", "reference"},
                    {"size", {plan.settings.width, plan.settings.height}},
                    {"exposure", arguments.exposure},
                    {"samples", arguments.targetNoise != 0.0 ? "" : describeRanges({plan.range})},
                    {"target_noise", arguments.targetNoise},
                    {"settings", referenceSettingsJson(plan.settings)}},
         .mainFile = "image.exr",
         .quiet = arguments.quiet,
         .json = arguments.json,
         .make = [&](const SequenceFrame& frame,
                     OutputFolder& folder) { return traceTo(folder, plan, frame.scene, frame.camera, frame.sceneHash, true, frame.stop, sayOnce).has_value(); },
         .earlier = leftBy("reference", {kSpecularPicture})},
        arguments);
}

int runReference(const ReferenceArguments& arguments)
{
    const ReferencePlan plan = planReference(arguments);
    const ThreadLimit threads(arguments.threads);
    refuseOtherResult(arguments.output, "reference");
    if (const std::optional<FrameRange> range = chosenFrames(arguments.sequence)) return traceFrames(plan, *range);

    OutputFolder folder(arguments.output);  // fails now rather than after hours
    const Scene scene = loadChosenScene(arguments);
    const CatchInterrupts catching;
    SayOnce sayOnce;
    const std::optional<Traced> traced =
        traceTo(folder, plan, scene, chosenCamera(scene, arguments), hashScene(scene), arguments.resume, catching.asked(), sayOnce);
    if (!traced) {
        std::cerr << "lrsm: interrupted; what is done is in " << arguments.output << " (--resume continues)" << std::endl;
        return kInterruptedCode;
    }
    folder.commit(leftBy("reference", {kSpecularPicture}));
    const Json& json = traced->json;
    if (arguments.json)
        std::cout << jsonText(json);
    else if (!arguments.quiet) {
        const auto figure = [](const Json& value) { return shortNumber(value.get<double>()); };
        std::cout << "  " << json["samples"] << " samples a pixel, model " << arguments.model << ", " << shortNumber(json["rays"]["total"].get<double>() * 1e-6)
                  << " million rays in " << figure(json["rays"]["seconds"]) << " s: " << figure(json["rays"]["million_per_second"]) << " million a second\n";
        if (std::isfinite(traced->noise)) std::cout << "  noise of the irradiance, RMSE / mean: " << shortNumber(traced->noise) << "\n";
        if (arguments.bareLoop)
            std::cout << "  bare loop over the same kind of rays: " << figure(json["bare_loop"]["million_per_second"]) << " million a second; ratio "
                      << figure(json["bare_loop"]["ratio"]) << "\n";
        std::cout << folder.path().string() << ": image.exr, PNGs, frame.json, samples.bin\n";
    }
    return 0;
}

}  // namespace

Command addReference(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("reference", "Path trace the same picture: the truth, with its variance");
    const auto options = std::make_shared<ReferenceArguments>();
    addSceneOptions(*parser, *options);
    addPictureOptions(*parser, *options);
    addRunOptions(*parser, *options);
    addSequenceOptions(*parser, options->sequence);
    parser->add_option("-o,--output", options->output, "folder for the results");
    CLI::Option* spp =
        parser->add_option("--spp", options->spp, "samples a pixel: the range 0:N; for a known time, and for ranges to be merged")->capture_default_str();
    CLI::Option* samples = parser->add_option("--samples", options->samples, "A:B: only samples A .. B-1, to be merged with others (lrsm merge)");
    parser
        ->add_option(
            "--target-noise", options->targetNoise,
            "as many samples as it takes for RMSE / mean of the irradiance to be at most this: for a truth of known quality (0.01: good, 0.003: very good)")
        ->excludes(spp)
        ->excludes(samples);
    parser->add_option("--model", options->model, "single: one diffuse bounce, what LRSM sets out to compute; full: every bounce, every BRDF")
        ->capture_default_str();
    parser->add_option("--specular-aperture", options->specularAperture, "degrees: adds the layer specular.cone, the mean radiance over this cone");
    parser->add_option("--seed", options->seed, "another seed gives an independent picture")->capture_default_str();
    parser
        ->add_option("--block", options->block,
                     "samples stratified against each other, a power of two; 64 from 512 samples on; the variance is taken over blocks")
        ->capture_default_str();
    parser->add_flag("--resume", options->resume, "continue what the folder holds, to the same bits; with a larger --spp, add to it");
    parser->add_option("--checkpoint-seconds", options->checkpointSeconds, "how often samples.bin is written; a kill loses no more")->capture_default_str();
    parser->add_option("--exposure", options->exposure, "stops for the PNGs; auto: from the picture, in quarter stops")->capture_default_str();
    parser->add_flag("--eye-side-only", options->eyeSide, "find lit surfaces by the paths' own rays alone: more noise, the same mean; to check the other way");
    parser->add_flag("--bare-loop", options->bareLoop, "also time the same rays without shading");
    return {parser, [options] { return runReference(*options); }};
}

}  // namespace lrsm
