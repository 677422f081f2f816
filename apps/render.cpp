#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/common/frame_files.h"
#include "apps/common/memory.h"
#include "apps/common/messages.h"
#include "apps/common/progress.h"
#include "apps/validate/split.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/scene/load_scene.h"
#include "core/scene/scene_hash.h"

#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace lrsm {

namespace {

struct RenderArguments : CommonOptions {
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

int runRender(const RenderArguments& options)
{
    if (options.output.empty() && options.pixel.empty()) throw InputError("render", "needs -o FOLDER (or --pixel x,y)");
    const Settings settings = chosenSettings(options);
    const IVec2 size = chosenSize(options);
    const std::optional<float> exposure = parseExposure(options.exposure);
    if (std::isnan(options.maxMemoryMegabytes) || options.maxMemoryMegabytes < 0.0) throw InputError("--max-memory", "must be 0 (no limit) or more");
    RenderOptions renderOptions{.width = size.x, .height = size.y, .lanes = options.lanes, .watch = {}, .method = chosenMethod(options, settings)};
    std::optional<IVec2> pixel;
    if (!options.pixel.empty()) pixel = parsePixel(options.pixel, size);
    std::optional<OutputFolder> folder;
    if (!options.output.empty()) folder.emplace(options.output);

    const ThreadLimit threads(options.threads);
    const Scene scene = loadChosenScene(options);
    const Camera camera = chosenCamera(scene, options);
    const Requirements needs = prepare(scene, settings);
    MemoryQuestion memory{scene, needs, settings, size.x, size.y};
    enforceMemoryLimit(memory, options.maxMemoryMegabytes);

    say(loadMessages(scene));
    say(extentMessages(scene, camera, settings));
    if (pixel) std::cout << explainPixel(scene, camera, settings, renderOptions, pixel->x, pixel->y);
    if (!folder) return 0;

    Progress progress(options.quiet);
    renderOptions.watch.progress = [&](const std::string& pass, double fraction) { progress.show(pass, fraction); };
    std::optional<Caches> caches;
    if (settings.method == Method::caches)
        renderOptions.watch.observe = [&](const std::string&, const PassOutput& output) {
            if (const auto* made = output.as<Caches>()) caches = *made;
        };
    const Frame frame = renderFrame(scene, camera, settings, renderOptions);
    progress.show("writing", 0.0);

    memory.rendered = &frame.passes;
    FrameRecord record{.scene = scene,
                       .camera = camera,
                       .settings = settings,
                       .preset = options.preset,
                       .sceneHash = hashScene(scene),
                       .memory = predictMemory(memory),
                       .exposureStops = exposure,
                       .radiance = options.radiance,
                       .caches = caches ? &*caches : nullptr};
    addMeasured(record.memory, frame.passes);
    const nlohmann::ordered_json json = frameJson(frame, record);
    writeFrame(*folder, frame, record, json);
    folder->commit();
    progress.clear();
    say(passMessages(frame.passes));
    say(darknessMessages(scene, {frame.gbuffer.position, frame.gbuffer.geometricNormal, frame.gbuffer.depthLinear}, frame.direct, frame.combined));

    if (options.json)
        std::cout << jsonText(json);
    else if (!options.quiet)
        printSummary(frame, record.memory, folder->path().string());
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
