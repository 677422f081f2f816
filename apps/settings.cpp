#include "apps/common/commands.h"
#include "core/base/errors.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

struct SettingsArguments {
    bool markdown = false, json = false;
    std::string preset;
    std::vector<std::string> keys;
};

void printSetting(const SettingInfo& info)
{
    std::cout << "  " << info.key << " = " << info.defaultValue << "   {" << info.allowed << "}" << (info.unit.empty() ? "" : " " + info.unit) << "\n      "
              << info.meaning << " [" << info.source << "]\n";
}

/// Those whose key holds a word.
void findSettings(const std::vector<std::string>& words)
{
    const std::vector<SettingInfo> all = describeSettings();
    for (const std::string& word : words) {
        const auto holds = [&](const SettingInfo& info) { return info.key.find(word) != std::string::npos; };
        if (std::none_of(all.begin(), all.end(), holds)) throw InputError("settings " + word, "no setting has this in its name; `lrsm settings` lists them");
        for (const SettingInfo& info : all)
            if (holds(info)) printSetting(info);
    }
}

void listSettings()
{
    std::string stage;
    for (const SettingInfo& info : describeSettings()) {
        if (info.stage != stage) std::cout << (stage.empty() ? "" : "\n") << (stage = info.stage) << "\n";
        printSetting(info);
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
    if (!options.keys.empty())
        findSettings(options.keys);
    else if (options.markdown)
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
    parser->add_option("KEY", options->keys, "only settings with this in their names");
    parser->add_option("--preset", options->preset, "what this preset changes against `balanced`");
    parser->add_flag("--json", options->json, "a preset's values as a settings file");
    parser->add_flag("--markdown", options->markdown, "docs/settings.md");
    return {parser, [options] { return runSettings(*options); }};
}

}  // namespace lrsm
