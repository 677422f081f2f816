#include "apps/manual.h"

#include "apps/common/commands.h"
#include "core/base/errors.h"
#include "core/base/text.h"
#include "core/scene/builtin_scenes.h"
#include "core/settings/settings_table.h"

#include <algorithm>
#include <iostream>
#include <memory>

namespace lrsm {

namespace {

/// Text for man: no backslash is an escape, no line begins with a request, a minus is one.
std::string roff(const std::string& text)
{
    std::string escaped;
    for (const char c : text) {
        if (c == '\\')
            escaped += "\\e";
        else if (c == '-')
            escaped += "\\-";
        else
            escaped += c;
        if (c == '\n') escaped += "\\&";
    }
    return "\\&" + escaped;
}

std::vector<const CLI::Option*> optionsOf(const CLI::App& app)
{
    return app.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

std::vector<const CLI::App*> commandsOf(const CLI::App& program)
{
    return program.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

bool takesValue(const CLI::Option& option)
{
    return option.get_items_expected_max() > 0;
}

/// "-o,--output TEXT"
std::string heading(const CLI::Option& option)
{
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    if (names.empty()) names.push_back(option.get_single_name());
    std::string text = joined(names, {}, ", ");
    if (takesValue(option) && !option.get_positional()) text += " " + option.get_type_name();
    if (!option.get_default_str().empty()) text += " (" + option.get_default_str() + ")";
    return text;
}

void addOptions(std::string& page, const CLI::App& app)
{
    for (const CLI::Option* option : optionsOf(app)) page += ".TP\n" + roff(heading(*option)) + "\n" + roff(option->get_description()) + "\n";
}

/// Of a scene, a preset, a setting, a file or folder; words of a list stand in the option's own check and are not known here.
std::string completionOf(const CLI::Option& option)
{
    const std::string name = option.get_single_name();
    if (name == "SCENE") return "compgen -W \"$scenes\" -- \"$cur\"; compgen -f -- \"$cur\"";
    if (name == "preset") return "compgen -W \"$presets\" -- \"$cur\"";
    if (name == "set") return "compgen -W \"$settings\" -- \"$cur\"";
    return "compgen -f -- \"$cur\"";
}

std::vector<std::string> namesOf(const CLI::Option& option)
{
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

/// The command of a command line.
const CLI::App* chosenCommand(const CLI::App& program, const std::vector<std::string>& arguments)
{
    for (const CLI::App* command : commandsOf(program))
        if (!arguments.empty() && command->get_name() == arguments[0]) return command;
    return nullptr;
}

/// "--voxel-resolution=64" -> "voxel_resolution", "64".
std::pair<std::string, std::string> keyAndValue(const std::string& argument, const std::string& next)
{
    const std::size_t begin = argument.find_first_not_of('-'), equals = argument.find('=');
    std::string key = begin == std::string::npos ? "" : argument.substr(begin, equals == std::string::npos ? equals : equals - begin);
    std::replace(key.begin(), key.end(), '-', '_');
    return {key, equals == std::string::npos ? (next.starts_with("-") || next.empty() ? "VALUE" : next) : argument.substr(equals + 1)};
}

bool isSetting(const std::string& key)
{
    const std::vector<SettingInfo> settings = describeSettings();
    return std::any_of(settings.begin(), settings.end(), [&](const SettingInfo& info) { return info.key == key; });
}

}  // namespace

std::string manPage(const CLI::App& program)
{
    std::string page = ".TH LRSM 1 \"\" \"lrsm " LRSM_VERSION "\" \"\"\n.SH NAME\nlrsm \\- layered reflective shadow maps on the CPU\n.SH SYNOPSIS\n";
    page += ".B lrsm\nCOMMAND [OPTIONS]\n.br\n.B lrsm help\n[COMMAND]\n.SH DESCRIPTION\n" + roff(program.get_description()) + "\n.SH COMMANDS\n";
    for (const CLI::App* command : commandsOf(program)) {
        page += ".SS lrsm " + roff(command->get_name()) + "\n" + roff(command->get_description()) + "\n";
        addOptions(page, *command);
        if (!command->get_footer().empty()) page += ".PP\n" + roff(command->get_footer()) + "\n";
    }
    page += ".SH SETTINGS\nGiven as \\-\\-set KEY=VALUE, or by \\-\\-preset and \\-\\-settings.\n";
    for (const SettingInfo& info : describeSettings())
        page += ".TP\n" + roff(info.key + " = " + info.defaultValue + "   {" + info.allowed + "}" + (info.unit.empty() ? "" : " " + info.unit)) + "\n" +
                roff(info.meaning + " [" + info.source + "]") + "\n";
    page += ".SH PRESETS\n";
    for (const PresetInfo& info : presetInfos()) page += ".TP\n" + roff(info.name) + "\n" + roff(info.summary) + "\n";
    return page + ".SH EXIT STATUS\n" + roff(program.get_footer()) + "\n";
}

std::string bashCompletion(const CLI::App& program)
{
    const std::vector<const CLI::App*> commands = commandsOf(program);
    const auto keys = joined(
        describeSettings(), [](const SettingInfo& info) { return info.key + "="; }, " ");
    std::string script =
        "# bash completion for lrsm, made by `lrsm completion bash`\n_lrsm() {\n    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n";
    script += "    local commands='" + joined(commands, &CLI::App::get_name, " ") + " help'\n";
    script += "    local scenes='" + joined(builtinScenes(), &BuiltinSceneInfo::name, " ") + "'\n";
    script += "    local presets='" + joined(presetInfos(), &PresetInfo::name, " ") + "'\n";
    script += "    local settings='" + keys + "'\n    local options= words=\n    COMPREPLY=()\n";
    script += "    if [ \"$COMP_CWORD\" = 1 ] || { [ \"$COMP_CWORD\" = 2 ] && [ \"$prev\" = help ]; }; then\n";
    script += "        COMPREPLY=($(compgen -W \"$commands\" -- \"$cur\")); return\n    fi\n    case ${COMP_WORDS[1]} in\n";
    for (const CLI::App* command : commands) {
        std::vector<std::string> all, flags;
        std::string positional = ":";
        script += "    " + command->get_name() + ")\n        case $prev in\n";
        for (const CLI::Option* option : optionsOf(*command)) {
            const std::vector<std::string> names = namesOf(*option);
            all.insert(all.end(), names.begin(), names.end());
            if (names.empty()) positional = completionOf(*option);
            if (!names.empty() && takesValue(*option)) script += "        " + joined(names, {}, "|") + ") words=$(" + completionOf(*option) + ");;\n";
        }
        script += "        *) options='" + joined(all, {}, " ") + "' words=$(" + positional + ");;\n        esac;;\n";
    }
    script +=
        "    esac\n    case $cur in\n    -*) COMPREPLY=($(compgen -W \"$options\" -- \"$cur\"));;\n    *) local IFS=$'\\n'; COMPREPLY=($words);;\n    esac\n";
    script += "    [ \"$prev\" != --set ] || compopt -o nospace\n}\ncomplete -o filenames -F _lrsm lrsm\n";
    return script;
}

std::string usageHint(const CLI::App& program, const std::vector<std::string>& arguments)
{
    const CLI::App* command = chosenCommand(program, arguments);
    if (!command) return "";
    std::vector<std::string> known;
    for (const CLI::Option* option : optionsOf(*command)) {
        const std::vector<std::string> names = namesOf(*option);
        known.insert(known.end(), names.begin(), names.end());
    }
    const bool hasSet = std::find(known.begin(), known.end(), "--set") != known.end();
    for (std::size_t i = 1; i < arguments.size(); ++i) {
        const std::string name = arguments[i].substr(0, arguments[i].find('='));
        const bool isOption = name.starts_with("-");
        if (std::find(known.begin(), known.end(), name) != known.end() || (!isOption && name == arguments[i])) continue;
        if (!isOption && arguments[i - 1] == "--set") continue;
        const auto [key, value] = keyAndValue(arguments[i], i + 1 < arguments.size() ? arguments[i + 1] : "");
        if (isSetting(key)) return hasSet ? "; a setting is given as --set " + key + "=" + value : "; `lrsm " + command->get_name() + "` takes no settings";
        if (!isOption) continue;
        const auto near = std::min_element(known.begin(), known.end(),
                                           [&](const std::string& a, const std::string& b) { return editDistance(a, name) < editDistance(b, name); });
        if (near != known.end() && name.size() > 3 && editDistance(*near, name) <= 2) return "; did you mean " + *near + "?";
    }
    return "";
}

Command addMan(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("man", "The manual page: lrsm man | man -l -");
    return {parser, [&program] {
                std::cout << manPage(program);
                return 0;
            }};
}

Command addCompletion(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("completion", "What a shell completes: source <(lrsm completion bash)");
    const auto shell = std::make_shared<std::string>("bash");
    parser->add_option("SHELL", *shell, "bash");
    return {parser, [&program, shell] {
                if (*shell != "bash") throw InputError("completion " + *shell, "there is none but for bash (zsh reads it too, after bashcompinit)");
                std::cout << bashCompletion(program);
                return 0;
            }};
}

}  // namespace lrsm
