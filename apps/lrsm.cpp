#include "apps/common/commands.h"
#include "apps/manual.h"
#include "core/base/errors.h"
#include "core/base/float_state.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/base/threads.h"

#include <unistd.h>
#include <algorithm>
#include <csignal>
#include <exception>
#include <iostream>
#include <new>
#include <system_error>
#include <thread>
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

/// `help COMMAND` is `COMMAND --help`, `help` is `--help`.
std::vector<std::string> plainArguments(int argc, char** argv)
{
    std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
    if (arguments.empty() || arguments[0] != "help") return arguments;
    std::erase(arguments, "help");
    arguments.push_back("--help");
    return arguments;
}

/// What takes less.
std::string lessMemory(const CLI::App& program)
{
    const std::vector<CLI::App*> chosen = program.get_subcommands();
    const auto takes = [&](const char* option) { return !chosen.empty() && chosen[0]->get_option_no_throw(option) != nullptr; };
    if (takes("--set"))
        return "lower --set voxel_resolution=N, rsm_resolution=N, depth_layers=N, normal_layers=N or --size (lrsm info SCENE says what each takes)";
    return takes("--size") ? "lower --size" : "close other programs, or use a machine with more of it";
}

/// Where to read on: " (lrsm help render)".
std::string helpFor(const CLI::App& program)
{
    for (const CLI::App* command : program.get_subcommands()) return " (lrsm help " + command->get_name() + ")";
    return " (lrsm help)";
}

/// CLI11 would only say that a command is missing.
void refuseUnknownCommand(const CLI::App& program, const std::string& word)
{
    const std::vector<const CLI::App*> commands = program.get_subcommands({});
    if (std::any_of(commands.begin(), commands.end(), [&](const CLI::App* command) { return command->get_name() == word; })) return;
    throw lrsm::InputError("there is no command \"" + word + "\"", "the commands are " + lrsm::joined(commands, &CLI::App::get_name));
}

/// Where the system grants fewer threads than there are processors: said, and kept to.
void keepToGrantedThreads()
{
    const int processors = std::max(1, int(std::thread::hardware_concurrency())), granted = lrsm::grantedThreads(processors);
    if (granted == processors) return;
    std::cerr << "lrsm: note: the system grants " << granted << (granted == 1 ? " thread" : " threads") << " where there are " << processors
              << " processors (ulimit -u, a container's limit, address space): slower, the same results" << std::endl;
    ::setenv("OPENIMAGEIO_THREADS", "1", 0);  // its pool is made when first used, one a processor
    // Never lifted: oneTBB would start the threads that are refused as soon as it were.
    [[maybe_unused]] static const lrsm::ThreadLimit* const kept = new lrsm::ThreadLimit(granted);
}

int runChosen(const std::vector<lrsm::Command>& commands)
{
    for (const lrsm::Command& command : commands)
        if (command.parser->parsed()) {
            keepToGrantedThreads();
            const int code = command.run();
            // Output lost on a full disk is a failure too.
            if (!std::cout.flush()) throw lrsm::MachineError("standard output", "cannot be written");
            return code;
        }
    return 0;
}

/// Where nothing catches: threads that a library wants and the system refuses, inside oneTBB or as OpenImageIO is loaded.
[[noreturn]] void endInOneLine() noexcept
{
    std::string line = "unexpected: the program cannot go on";
    try {
        if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
    } catch (const std::exception& error) {
        const bool refused = dynamic_cast<const std::system_error*>(&error) || std::string_view(error.what()).starts_with("pthread_create");
        line = refused ? "threads: the system refuses one that is needed (ulimit -u, or a container's limit, allows too few)"
                       : std::string("unexpected: ") + error.what();
    } catch (...) {
    }
    line = "lrsm: " + line + "\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line.data(), line.size());
    ::_exit(3);
}

}  // namespace

int main(int argc, char** argv)
{
    std::set_terminate(endInOneLine);
    const lrsm::FloatState floats;
    // A file size limit then shows as an error of write(), which is reported, instead of ending the program.
    std::signal(SIGXFSZ, SIG_IGN);

    CLI::App program("Layered reflective shadow maps on the CPU: golden images, golden buffers, and how far from the truth they are.", "lrsm");
    program.set_version_flag("-v,--version", LRSM_VERSION);
    program.require_subcommand(1);
    program.footer("lrsm help COMMAND says what a command takes. Exit codes: 0 done, 1 a check failed, 2 bad usage or input, 3 the machine failed us.");
    const std::vector<lrsm::Command> commands = {lrsm::addInfo(program),    lrsm::addRender(program),    lrsm::addReference(program), lrsm::addMerge(program),
                                                 lrsm::addCompare(program), lrsm::addValidate(program),  lrsm::addCapture(program),   lrsm::addCheck(program),
                                                 lrsm::addBench(program),   lrsm::addSettings(program),  lrsm::addSweep(program),     lrsm::addTune(program),
                                                 lrsm::addMan(program),     lrsm::addCompletion(program)};
    const std::vector<std::string> arguments = plainArguments(argc, argv);

    try {
        if (!arguments.empty() && !arguments[0].starts_with("-")) refuseUnknownCommand(program, arguments[0]);
        if (arguments.empty()) {
            std::cerr << program.help();
            return 2;
        }
        program.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
        return runChosen(commands);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
        return report(std::string(error.what()) + lrsm::usageHint(program, arguments) + helpFor(program), 2);
    } catch (const lrsm::InputError& error) {
        return report(error.what(), 2);
    } catch (const lrsm::MachineError& error) {
        return report(error.what(), 3);
    } catch (const std::bad_alloc&) {
        return report("memory: there is not enough; " + lessMemory(program), 3);
    } catch (const std::system_error& error) {
        return report(std::string("threads: the system refuses what is needed: ") + error.what(), 3);
    } catch (const std::exception& error) {
        return report(std::string("unexpected: ") + error.what(), 3);
    }
}
