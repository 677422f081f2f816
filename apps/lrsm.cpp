#include "apps/common/commands.h"
#include "core/base/errors.h"
#include "core/base/float_state.h"
#include "core/base/text.h"

#include <algorithm>
#include <csignal>
#include <iostream>
#include <new>
#include <vector>

namespace {

/// The one line a user reads.
int report(const std::string& message, int code)
{
    std::string line = message;
    std::replace_if(
        line.begin(), line.end(), [](char letter) { return letter == '\n' || letter == '\r'; }, ' ');
    std::cerr << "lrsm: " << line << std::endl;
    return code;
}

/// CLI11 would only say that a command is missing.
void refuseUnknownCommand(const CLI::App& program, const char* word)
{
    const std::vector<const CLI::App*> commands = program.get_subcommands({});
    if (std::any_of(commands.begin(), commands.end(), [&](const CLI::App* command) { return command->get_name() == word; })) return;
    throw lrsm::InputError("there is no command \"" + std::string(word) + "\"", "the commands are " + lrsm::joined(commands, &CLI::App::get_name));
}

int runChosen(const std::vector<lrsm::Command>& commands)
{
    for (const lrsm::Command& command : commands)
        if (command.parser->parsed()) {
            const int code = command.run();
            // Output lost on a full disk is a failure too.
            if (!std::cout.flush()) throw lrsm::MachineError("standard output", "cannot be written");
            return code;
        }
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    const lrsm::FloatState floats;
    // A file size limit then shows as an error of write(), which is reported, instead of ending the program.
    std::signal(SIGXFSZ, SIG_IGN);

    CLI::App program("Layered reflective shadow maps on the CPU: golden images, golden buffers, and how far from the truth they are.", "lrsm");
    program.set_version_flag("--version", LRSM_VERSION);
    program.require_subcommand(1);
    program.footer("Exit codes: 0 done, 1 a check failed, 2 bad usage or input, 3 the machine failed us.");
    const std::vector<lrsm::Command> commands = {lrsm::addInfo(program),    lrsm::addRender(program),   lrsm::addReference(program), lrsm::addMerge(program),
                                                 lrsm::addCompare(program), lrsm::addValidate(program), lrsm::addCapture(program),   lrsm::addCheck(program),
                                                 lrsm::addBench(program),   lrsm::addSettings(program), lrsm::addSweep(program),     lrsm::addTune(program)};

    try {
        if (argc > 1 && argv[1][0] != '-') refuseUnknownCommand(program, argv[1]);
        program.parse(argc, argv);
        return runChosen(commands);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
        return report(std::string(error.what()) + " (lrsm --help)", 2);
    } catch (const lrsm::InputError& error) {
        return report(error.what(), 2);
    } catch (const lrsm::MachineError& error) {
        return report(error.what(), 3);
    } catch (const std::bad_alloc&) {
        return report("memory: not enough for this scene and these settings; lower voxel_resolution or rsm_resolution (lrsm info predicts)", 3);
    } catch (const std::exception& error) {
        return report(std::string("unexpected: ") + error.what(), 3);
    }
}
