#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// What `--help` is made of, told to a manual page and to a shell.
namespace lrsm {

/// lrsm.1, in man's macros: every command with its options, every setting.
std::string manPage(const CLI::App& program);

/// For bash: commands, options, and the values of those that take a setting, a preset, a scene or one of a few words.
std::string bashCompletion(const CLI::App& program);

/// What a command line that was not understood may have meant: settings without --set, near misses of an option's name. "" where nothing comes to mind.
std::string usageHint(const CLI::App& program, const std::vector<std::string>& arguments);

}  // namespace lrsm
