#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/common/memory.h"
#include "apps/info/describe_analysis.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"
#include "core/scene/builtin_scenes.h"
#include "core/scene/load_scene.h"
#include "core/scene/scene_hash.h"
#include "core/settings/settings_table.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

struct InfoArguments : CommonOptions {
    bool list = false;
};

int listBuiltins(bool json)
{
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const BuiltinSceneInfo& info : builtinScenes()) {
        names.push_back({{"name", info.name}, {"summary", info.summary}});
        if (!json) std::cout << info.name << ": " << info.summary << "\n";
    }
    if (json) std::cout << jsonText(names);
    return 0;
}

int runInfo(const InfoArguments& options)
{
    if (options.list) return listBuiltins(options.json);
    const Settings settings = chosenSettings(options);
    const IVec2 size = chosenSize(options);
    const ThreadLimit threads(options.threads);
    const Scene scene = loadChosenScene(options);
    const Requirements needs = analyseRequirements(scene, settings.force);
    const SceneAnalysis analysis = analyseScene(scene, chosenCamera(scene, options), needs, settings, size.x, size.y);
    const std::vector<Advice> advice = adviseSettings(analysis, settings, size.x, size.y);
    const auto memory = predictMemory({scene, needs, settings, size.x, size.y});

    if (options.json) {
        const nlohmann::ordered_json json = {{"version", LRSM_VERSION},
                                             {"scene", sceneJson(scene, hashScene(scene))},
                                             {"requires", requirementsJson(needs)},
                                             {"settings", settingsToJson(settings)},
                                             {"memory", memoryJson(memory)},
                                             {"analysis", analysisJson(analysis)},
                                             {"advice", adviceJson(advice)}};
        std::cout << jsonText(json);
        return 0;
    }
    printScene(std::cout, scene);
    printRequirements(std::cout, needs);
    printAnalysis(std::cout, analysis);
    printAdvice(std::cout, advice);
    std::cout << "memory of a frame with these settings, in MB of 10^6 bytes:\n";
    printMemory(std::cout, memory);
    return 0;
}

}  // namespace

Command addInfo(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("info", "What is in a scene, what it requires, how much memory a frame takes");
    const auto options = std::make_shared<InfoArguments>();
    addSceneOptions(*parser, *options);
    addSettingOptions(*parser, *options);
    addPictureOptions(*parser, *options);
    addRunOptions(*parser, *options);
    parser->add_flag("--list", options->list, "list the built-in scenes");
    return {parser, [options] { return runInfo(*options); }};
}

}  // namespace lrsm
