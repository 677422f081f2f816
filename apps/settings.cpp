#include "apps/common/commands.h"
#include "core/settings/settings_table.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

struct SettingsArguments {
    bool markdown = false, json = false;
    std::string preset;
};

void listSettings()
{
    std::string stage;
    for (const SettingInfo& info : describeSettings()) {
        if (info.stage != stage) std::cout << (stage.empty() ? "" : "\n") << (stage = info.stage) << "\n";
        std::cout << "  " << info.key << " = " << info.defaultValue << "   {" << info.allowed << "}" << (info.unit.empty() ? "" : " " + info.unit) << "\n      "
                  << info.meaning << " [" << info.source << "]\n";
    }
    std::cout << "\npresets\n";
    for (const PresetInfo& info : presetInfos()) std::cout << "  " << info.name << ": " << info.summary << "\n";
}

void showPreset(const std::string& name)
{
    for (const SettingDifference& change : differences(preset("balanced"), preset(name)))
        std::cout << change.key << " = " << change.b << "   (balanced: " << change.a << ")\n";
}

int runSettings(const SettingsArguments& options)
{
    if (options.markdown)
        std::cout << settingsMarkdown();
    else if (options.json)
        std::cout << settingsToJson(preset(options.preset.empty() ? "balanced" : options.preset)).dump(2) << "\n";
    else if (!options.preset.empty())
        showPreset(options.preset);
    else
        listSettings();
    return 0;
}

}  // namespace

Command addSettings(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("settings", "List every setting and preset");
    const auto options = std::make_shared<SettingsArguments>();
    parser->add_option("--preset", options->preset, "what this preset changes against `balanced`");
    parser->add_flag("--json", options->json, "a preset's values as a settings file");
    parser->add_flag("--markdown", options->markdown, "docs/settings.md");
    return {parser, [options] { return runSettings(*options); }};
}

}  // namespace lrsm
