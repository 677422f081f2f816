#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/common/earlier_result.h"
#include "apps/common/frame_files.h"
#include "apps/common/memory.h"
#include "apps/common/messages.h"
#include "apps/common/progress.h"
#include "apps/common/sequence.h"
#include "apps/validate/split.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/scene/scene_hash.h"
#include "core/settings/settings_table.h"

#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

struct RenderArguments : CommonOptions {
    SequenceArguments sequence;
    std::string output, pixel, exposure = "auto", radiance = "lrsm";
    double maxMemoryMegabytes = 0.0;
    int lanes = 0;
};

/// None: that of the settings.
GatherMethod chosenMethod(const RenderArguments& options, const Settings& settings)
{
    if (options.radiance != "lrsm" && options.radiance != "exact") throw InputError("--radiance " + options.radiance, "must be lrsm or exact");
    return options.radiance == "exact" ? exactRadianceMethod(settings.cones.march.visibility) : GatherMethod{};
}

void printSummary(const Frame& frame, const std::vector<MemoryRow>& memory, const std::string& where)
{
    double all = 0.0;
    for (const PassReport& pass : frame.passes) all += pass.milliseconds;
    for (const PassReport& pass : frame.passes)
        std::cout << "  " << std::left << std::setw(12) << pass.name << std::right << std::fixed << std::setprecision(1) << std::setw(9) << pass.milliseconds
                  << " ms" << std::setw(7) << (all > 0.0 ? 100.0 * pass.milliseconds / all : 0.0) << " %" << std::setw(13) << megabytes(pass.bytes) << "\n";
    std::cout << "  " << std::left << std::setw(12) << "frame" << std::right << std::setw(9) << all << " ms\n";
    for (const MemoryRow& row : memory)
        if (row.measured && *row.measured != row.predicted)
            std::cout << "  " << row.structure << ": predicted " << megabytes(row.predicted) << ", held " << megabytes(*row.measured) << "\n";
    std::cout << where << ": image.exr, image.png and one PNG a part, frame.json\n";
}

/// What a frame is rendered with, besides its scene.
struct RenderPlan {
    const RenderArguments& arguments;
    Settings settings;
    IVec2 size{0};
    std::optional<float> exposure;
    RenderOptions options;
};

RenderPlan planRender(const RenderArguments& arguments)
{
    RenderPlan plan{arguments, chosenSettings(arguments), chosenSize(arguments), parseExposure(arguments.exposure), {}};
    if (std::isnan(arguments.maxMemoryMegabytes) || arguments.maxMemoryMegabytes < 0.0) throw InputError("--max-memory", "must be 0 (no limit) or more");
    plan.options = {.width = plan.size.x, .height = plan.size.y, .lanes = arguments.lanes, .watch = {}, .method = chosenMethod(arguments, plan.settings)};
    return plan;
}

struct Rendered {
    Json json;  ///< frame.json
    Frame frame;
    std::vector<MemoryRow> memory;
};

/// Refuses what cannot be rendered, and tells what the user should know before.
void admit(const RenderPlan& plan, const Scene& scene, const Camera& camera, SayOnce& sayOnce)
{
    const Requirements needs = prepare(scene, plan.settings);
    enforceMemoryLimit({scene, needs, plan.settings, plan.size.x, plan.size.y}, plan.arguments.maxMemoryMegabytes);
    sayOnce(loadMessages(scene, plan.arguments.verbose));
    sayOnce(extentMessages(scene, camera, plan.settings));
}

/// One frame to its files, which are not committed.
Rendered renderTo(OutputFolder& folder, const RenderPlan& plan, const Scene& scene, const Camera& camera, const std::string& sceneHash, SayOnce& sayOnce,
                  World* kept = nullptr)
{
    Progress progress(plan.arguments.quiet);
    RenderOptions options = plan.options;
    options.kept = kept;
    options.watch.progress = [&](const std::string& pass, double fraction) { progress.show(pass, fraction); };
    std::optional<Caches> caches;
    std::optional<SeenProxies> proxies;
    if (plan.settings.method == Method::caches)
        options.watch.observe = [&](const std::string&, const PassOutput& output) {
            if (const auto* made = output.as<Caches>()) caches = *made;
        };
    if (plan.settings.method == Method::proxies) {
        proxies.emplace();
        options.watch.observe = [&](const std::string& pass, const PassOutput& output) {
            if (const auto* cells = output.as<ProxyCells>()) proxies->cells = *cells;
            if (const auto* lists = output.as<VisibilityLists>()) (pass == "pp march" ? proxies->marched : proxies->filtered) = *lists;
        };
    }
    Rendered rendered{.json = {}, .frame = renderFrame(scene, camera, plan.settings, options), .memory = {}};
    const Frame& frame = rendered.frame;
    progress.show("writing", 0.0);

    MemoryQuestion memory{scene, frame.needs, plan.settings, plan.size.x, plan.size.y};
    memory.rendered = &frame.passes;
    FrameRecord record{.scene = scene,
                       .camera = camera,
                       .settings = plan.settings,
                       .preset = plan.arguments.preset,
                       .sceneHash = sceneHash,
                       .memory = predictMemory(memory),
                       .exposureStops = plan.exposure,
                       .radiance = plan.arguments.radiance,
                       .caches = caches ? &*caches : nullptr,
                       .proxies = proxies ? &*proxies : nullptr};
    addMeasured(record.memory, frame.passes);
    rendered.json = frameJson(frame, record);
    writeFrame(folder, frame, record, rendered.json);
    progress.clear();
    sayOnce(passMessages(frame.passes));
    sayOnce(darknessMessages(scene, {frame.gbuffer.position, frame.gbuffer.geometricNormal, frame.gbuffer.depthLinear}, frame.direct, frame.combined));
    rendered.memory = std::move(record.memory);
    return rendered;
}

OutputFolder::Earlier earlierRender()
{
    return leftBy("render", {kCachesPicture, kProxiesPicture});
}

int renderFrames(const RenderPlan& plan, const FrameRange& range)
{
    const RenderArguments& arguments = plan.arguments;
    SayOnce sayOnce;
    World world;
    return runSequence({.range = range,
                        .folder = arguments.output,
                        .common = {{"command", "render"},
                                   {"size", {plan.size.x, plan.size.y}},
                                   {"exposure", arguments.exposure},
                                   {"radiance", arguments.radiance},
                                   {"preset", arguments.preset},
                                   {"settings", settingsToJson(plan.settings)}},
                        .mainFile = "image.exr",
                        .quiet = arguments.quiet,
                        .json = arguments.json,
                        .make =
                            [&](const SequenceFrame& frame, OutputFolder& folder) {
                                admit(plan, frame.scene, frame.camera, sayOnce);
                                renderTo(folder, plan, frame.scene, frame.camera, frame.sceneHash, sayOnce, range.reuse ? &world : nullptr);
                                return true;
                            },
                        .earlier = earlierRender()},
                       arguments);
}

int runRender(const RenderArguments& arguments)
{
    if (arguments.output.empty() && arguments.pixel.empty()) throw InputError("render", "needs -o FOLDER (or --pixel x,y)");
    const RenderPlan plan = planRender(arguments);
    std::optional<IVec2> pixel;
    if (!arguments.pixel.empty()) pixel = parsePixel(arguments.pixel, plan.size);
    const ThreadLimit threads(arguments.threads);
    if (!arguments.output.empty()) refuseOtherResult(arguments.output, "render");
    if (const std::optional<FrameRange> range = chosenFrames(arguments.sequence)) {
        if (pixel) throw InputError("--pixel", "is of one picture; give --time in place of --frames");
        return renderFrames(plan, *range);
    }
    std::optional<OutputFolder> folder;
    if (!arguments.output.empty()) folder.emplace(arguments.output);

    const Scene scene = loadChosenScene(arguments);
    const Camera camera = chosenCamera(scene, arguments);
    SayOnce sayOnce;
    admit(plan, scene, camera, sayOnce);
    if (pixel) std::cout << explainPixel(scene, camera, plan.settings, plan.options, pixel->x, pixel->y);
    if (!folder) return 0;

    const Rendered rendered = renderTo(*folder, plan, scene, camera, hashScene(scene), sayOnce);
    folder->commit(earlierRender());
    if (arguments.json)
        std::cout << jsonText(rendered.json);
    else if (!arguments.quiet)
        printSummary(rendered.frame, rendered.memory, folder->path().string());
    return 0;
}

}  // namespace

Command addRender(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("render", "Render a frame: EXR layers, PNGs, frame.json");
    const auto options = std::make_shared<RenderArguments>();
    addSceneOptions(*parser, *options);
    addSettingOptions(*parser, *options);
    addPictureOptions(*parser, *options);
    addRunOptions(*parser, *options);
    addSequenceOptions(*parser, options->sequence);
    parser->add_option("-o,--output", options->output, "folder for the results; they appear whole or not at all");
    parser->add_option("--pixel", options->pixel, "x,y: print how this pixel came about, cone by cone, step by step");
    parser
        ->add_option("--radiance", options->radiance,
                     "lrsm, or exact: with visibility=rays or voxel-rays the light of what is hit by shadow rays, to see what the LRSM costs")
        ->capture_default_str();
    parser->add_option("--exposure", options->exposure, "stops for the PNGs; auto: from the picture, in quarter stops")->capture_default_str();
    parser->add_option("--lanes", options->lanes, "pixels that the cones' kernel takes at a time; 0: as many as this machine can; the picture is the same")
        ->check(CLI::IsMember({0, 4, 8, 16}));
    parser->add_option("--max-memory", options->maxMemoryMegabytes, "MB of 10^6 bytes; a frame that needs more is refused before it starts");
    return {parser, [options] { return runRender(*options); }};
}

}  // namespace lrsm
