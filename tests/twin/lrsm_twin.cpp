// lrsm_twin GOLDEN [options]: the passes of a capture once more, on OpenGL.
#include "tests/twin/compare.h"
#include "tests/twin/passes.h"
#include "tests/twin/vectors.h"

#include <cstdio>
#include <exception>
#include <fstream>
#include <map>

namespace {

using namespace lrsm::twin;

struct Arguments {
    std::string golden, candidate, vectors;
    std::string plant;
    std::vector<std::string> frames;
    bool fromGolden = false, driverFormats = false;
    int repeats = 1;
};

int usage()
{
    std::puts(
        "lrsm_twin GOLDEN [options]\n"
        "lrsm_twin --vectors DIR      results of what `lrsm validate --vectors DIR` asks, beside the inputs\n\n"
        "Runs the passes of the capture GOLDEN on OpenGL 4.5, compares, and writes the buffers to CANDIDATE.\n"
        "  -o CANDIDATE      folder for the buffers\n"
        "  --from-golden     each pass reads the golden's buffers: differences do not add up\n"
        "  --driver-formats  conversions and 8-bit filtering as the driver does them\n"
        "  --repeat N        time: the shortest of N runs\n"
        "  --frame FILE      a frame.json of the same frame, to print its times beside; more than one: the shortest\n"
        "  --plant NAME      with one of these errors:");
    for (const Plant& plant : plants()) std::printf("    %-18s %-10s %s\n", plant.name, plant.pass, plant.meaning);
    return 2;
}

bool parse(int argc, char** argv, Arguments& to)
{
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        const bool more = i + 1 < argc;
        if (argument == "--from-golden") {
            to.fromGolden = true;
        } else if (argument == "--driver-formats") {
            to.driverFormats = true;
        } else if (argument == "--frame" && more) {
            to.frames.push_back(argv[++i]);
        } else if (argument == "-o" && more) {
            to.candidate = argv[++i];
        } else if (argument == "--vectors" && more) {
            to.vectors = argv[++i];
        } else if (argument == "--plant" && more) {
            to.plant = argv[++i];
        } else if (argument == "--repeat" && more) {
            to.repeats = std::max(1, std::atoi(argv[++i]));
        } else if (argument[0] != '-' && to.golden.empty()) {
            to.golden = argument;
        } else {
            return false;
        }
    }
    return to.golden.empty() != to.vectors.empty();
}

/// Milliseconds of each pass in the fastest of some frame.json.
std::map<std::string, double> timesOf(const std::vector<std::string>& files)
{
    std::map<std::string, double> times;
    for (const std::string& file : files) {
        std::ifstream in(file);
        const Json frame = Json::parse(in);
        for (const Json& pass : frame["passes"]) {
            const double milliseconds = pass["milliseconds"];
            const auto [at, isNew] = times.emplace(pass["name"], milliseconds);
            if (!isNew) at->second = std::min(at->second, milliseconds);
        }
    }
    return times;
}

void printTimes(const Frame& frame, const std::map<std::string, double>& others)
{
    std::printf("\n%-12s %10s %10s %8s\n", "pass", "OpenGL", "lrsm", "ratio");
    for (const auto& [pass, seconds] : frame.seconds()) {
        const auto other = others.find(pass);
        std::printf("%-12s %7.1f ms", pass.c_str(), 1e3 * seconds);
        if (other != others.end()) std::printf(" %7.1f ms %8.2f", other->second, 1e3 * seconds / other->second);
        std::printf("\n");
    }
}

int run(const Arguments& arguments)
{
    std::string whyNot;
    const auto context = GlContext::create(whyNot);
    if (!context) {
        std::fprintf(stderr, "lrsm_twin: %s\n", whyNot.c_str());
        return 3;
    }
    std::printf("%s\n", context->renderer().c_str());
    if (!arguments.vectors.empty()) {
        Programs programs;
        for (const std::string& name : runVectors(programs, arguments.vectors, arguments.vectors)) std::printf("left out: %s\n", name.c_str());
        return 0;
    }
    Frame frame(arguments.golden, !arguments.fromGolden);
    frame.repeats = arguments.repeats;
    Programs programs;
    for (const std::string& line : runAll(frame, {programs, arguments.plant, arguments.driverFormats})) std::printf("left out: %s\n", line.c_str());
    if (!arguments.candidate.empty()) frame.write(arguments.candidate);

    std::printf("\n%-26s %9s %9s %9s  %-10s %10s\n", "buffer", "elements", "differ", "outside", "tolerance", "largest");
    bool accepted = true;
    for (const Difference& d : differences(frame)) {
        std::printf("%-26s %9zu %9zu %9zu  %-8s %8.3g %8.3g %s\n", d.name.c_str(), d.elements, d.differing, d.outside, d.kind.c_str(), d.value, d.largest,
                    d.accepted() ? "" : "  REFUSED");
        accepted = accepted && d.accepted();
    }
    printTimes(frame, timesOf(arguments.frames));
    return accepted ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv)
{
    Arguments arguments;
    if (!parse(argc, argv, arguments)) return usage();
    try {
        return run(arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lrsm_twin: %s\n", error.what());
        return 3;
    }
}
