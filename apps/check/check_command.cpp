#include "apps/capture/capture_files.h"
#include "apps/capture/passes.h"
#include "apps/capture/pictures.h"
#include "apps/check/bless.h"
#include "apps/check/check_bundle.h"
#include "apps/check/check_report.h"
#include "apps/check/texel_inputs.h"
#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/common/progress.h"
#include "core/base/errors.h"
#include "core/base/parallel.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

struct CheckArguments : CommonOptions {
    std::string golden, candidate, output, map, junit, reason;
    std::vector<std::string> only;
    bool fromGolden = false, exact = false, noHints = false, bless = false;
};

void refuseMixtures(const CheckArguments& options)
{
    if (!options.bless && !options.reason.empty()) throw InputError("--reason", "has no meaning without --bless");
    if (!options.bless) return;
    if (options.reason.empty()) throw InputError("--bless", "needs --reason \"...\": why may the golden change?");
    if (options.fromGolden || !options.only.empty() || !options.map.empty() || !options.output.empty() || !options.junit.empty())
        throw InputError("--bless", "takes the whole candidate as it is; leave out -o, --map, --only, --from-golden and --junit");
}

int bless(const CheckArguments& options)
{
    const Capture golden = readCapture(options.golden), candidate = readCapture(options.candidate);
    const Capture next = blessed(golden, candidate, options.reason, LRSM_VERSION);
    if (next.history.size() == golden.history.size()) {
        if (!options.quiet) std::cout << options.golden << ": nothing changed, nothing was written\n";
        return 0;
    }
    OutputFolder folder(options.golden);
    writeCapture(folder, next);
    writePictures(folder, next);
    folder.commit();
    if (options.quiet) return 0;
    std::cout << options.golden << ": " << next.history.back().buffers.size() << " buffers changed, recorded in " << kManifestFile << ":";
    for (const std::string& name : next.history.back().buffers) std::cout << " " << name;
    std::cout << "\n";
    return 0;
}

/// What the wrong texel is made from, on the terminal too.
void printInputs(const CheckReport& report, const Capture& inputs)
{
    const CheckedBuffer* wrong = report.firstWrong();
    if (!wrong || !wrong->comparison().first) return;
    const std::size_t element = wrong->comparison().first->element;
    std::cout << "\n"
              << wrong->golden->name << ", " << placeText(*wrong->golden, element) << "\n  expected   " << texelText(wrong->expected(), element)
              << "\n  candidate  " << texelText(wrong->candidate->buffer, element) << "\n  made from\n";
    for (const TexelInput& input : inputsOf(inputs, wrong->expected(), element)) std::cout << "    " << input.what << ": " << input.value << "\n";
}

void print(const CheckArguments& options, const CheckReport& report, const Capture& inputs)
{
    if (options.json) {
        std::cout << jsonText(checkJson(report));
        return;
    }
    std::cout << report.summary() << "\n";
    if (options.quiet) return;
    for (const std::string& note : report.notes) std::cout << "note: " << note << "\n";
    std::cout << "\n" << checkTable(report);
    printInputs(report, inputs);
    if (report.firstWrong() && !options.fromGolden)
        std::cout << "\nWhat follows a wrong pass is wrong by its inputs: --from-golden judges each pass by the candidate's own.\n";
}

int runCheck(const CheckArguments& options)
{
    refuseMixtures(options);
    const ThreadLimit threads(options.threads);
    if (options.bless) return bless(options);
    if (!options.output.empty()) OutputFolder probe(options.output);

    Progress progress(options.quiet);
    progress.show("reading", 0.0);
    Capture golden = readCapture(options.golden);
    if (options.exact) demandBits(golden);
    CheckOptions chosen;
    chosen.fromGolden = options.fromGolden;
    chosen.passes = options.only;
    chosen.hints = !options.noHints;
    chosen.progress = [&](const std::string& pass, double fraction) { progress.show(pass, fraction); };
    // With --from-golden a pass that is not asked for still is the input of one that is.
    const Candidate candidate = readCandidate(options.candidate, golden, {options.map, options.fromGolden ? std::vector<std::string>() : chosen.passes});
    const CheckReport report = checkCandidate(golden, candidate, chosen);
    progress.clear();

    const Capture mixed = options.fromGolden ? layOver(golden, candidate) : Capture();
    const Capture& inputs = options.fromGolden ? mixed : golden;
    const std::string title = options.candidate + " against " + options.golden;
    print(options, report, inputs);
    if (!options.junit.empty()) {
        const std::string xml = checkJUnit(report, title);
        writeFileWhole(options.junit, std::as_bytes(std::span(xml.data(), xml.size())));
    }
    if (!options.output.empty()) {
        OutputFolder folder(options.output);
        writeCheck(folder, report, inputs, title);
        folder.commit();
        if (!options.quiet && !options.json)
            std::cout << "\n"
                      << options.output << ": report.html, check.json" << (report.holds() ? "" : ", expected, actual and difference of what is wrong") << "\n";
    }
    if (report.firstWrong()) return 1;
    return report.holds() ? 0 : 2;
}

}  // namespace

Command addCheck(CLI::App& program)
{
    CLI::App* parser =
        program.add_subcommand("check", "Hold another implementation's buffers against a golden capture, pass by pass (docs/check.md); 1 if one is wrong");
    const auto options = std::make_shared<CheckArguments>();
    addRunOptions(*parser, *options);
    parser->add_option("GOLDEN", options->golden, "folder that `lrsm capture` wrote")->required();
    parser->add_option("CANDIDATE", options->candidate, "folder with some or all of the buffers, as .npy, .npz, .dds, .exr, .png or raw .bin")->required();
    parser->add_option("-o,--output", options->output, "folder for report.html, check.json, and expected, actual and difference of what is wrong");
    parser->add_option("--map", options->map, "JSON that says where the candidate's buffers are, and how they are stored");
    parser->add_flag("--from-golden", options->fromGolden, "judge each pass by what ours makes of the candidate's own inputs");
    parser->add_flag("--exact", options->exact, "every buffer must have the golden's very bits, whatever its tolerance: for captures by this program");
    parser->add_option("--only", options->only, "passes to compare: " + passNames())->check(passNameError, "")->delimiter(',')->allow_extra_args(false);
    parser->add_option("--junit", options->junit, "file for a JUnit report");
    parser->add_flag("--no-hints", options->noHints, "compare only: do not look for what the error may be");
    parser->add_flag("--bless", options->bless, "make the candidate, a whole capture of the same frame, the golden");
    parser->add_option("--reason", options->reason, "why: it is recorded in the golden's manifest");
    return {parser, [options] { return runCheck(*options); }};
}

}  // namespace lrsm
