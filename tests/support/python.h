#pragma once

#include <sys/wait.h>
#include <array>
#include <cstdio>
#include <optional>
#include <string>

/// What a shell command prints (both streams), and how it ends.
struct CommandOutcome {
    int code = -1;
    std::string text;
};
inline CommandOutcome runCommand(const std::string& command)
{
    CommandOutcome outcome;
    std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (!pipe) return outcome;
    std::array<char, 4096> block;
    for (std::size_t n; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;) outcome.text.append(block.data(), n);
    const int status = ::pclose(pipe);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

/// A Python 3 that has the module: the one on the path, else Debian's. Tests that need one begin with LRSM_NEED_PYTHON and are visibly skipped
/// without.
inline std::optional<std::string> pythonWith(const std::string& module)
{
    for (const char* python : {"python3", "/usr/bin/python3"})
        if (runCommand(std::string(python) + " -c 'import " + module + "'").code == 0) return python;
    return {};
}

#define LRSM_NEED_PYTHON(variable, module)                                                    \
    const std::optional<std::string> variable##Found = pythonWith(module);                    \
    if (!variable##Found) {                                                                   \
        WARN("SKIPPED: no python3 with " << module << " (Debian: python3-" << module << ")"); \
        return;                                                                               \
    }                                                                                         \
    const std::string variable = *variable##Found
