#pragma once

#include <CLI/CLI.hpp>
#include <functional>

/// The subcommands, one file each. To add one: write `Command addName(CLI::App& program)` in name.cpp, declare it here and list it in lrsm.cpp.
namespace lrsm {

/// Exit codes: 0 done, 1 a check failed, 2 bad usage or input (InputError), 3 the machine failed us (MachineError).
struct Command {
    CLI::App* parser = nullptr;
    std::function<int()> run;  ///< returns 0 or 1; bad input and machine trouble are thrown
};

Command addBench(CLI::App& program);
Command addCapture(CLI::App& program);
Command addCheck(CLI::App& program);
Command addCompare(CLI::App& program);
Command addCompletion(CLI::App& program);
Command addInfo(CLI::App& program);
Command addMan(CLI::App& program);
Command addMerge(CLI::App& program);
Command addReference(CLI::App& program);
Command addRender(CLI::App& program);
Command addSettings(CLI::App& program);
Command addSweep(CLI::App& program);
Command addTune(CLI::App& program);
Command addValidate(CLI::App& program);

}  // namespace lrsm
