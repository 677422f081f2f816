#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/common/progress.h"
#include "apps/validate/validation_report.h"
#include "apps/validate/vectors/make_vectors.h"
#include "apps/validate/vectors/vector_files.h"
#include "core/base/errors.h"
#include "core/base/output_folder.h"
#include "core/base/parallel.h"
#include "core/report/chart.h"
#include "core/report/html.h"
#include "core/scene/load_scene.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace lrsm {
namespace {

using Json = nlohmann::ordered_json;

struct ValidateArguments : CommonOptions {
    std::string output, equation, only, vectors, against, junit;
    int samples = LadderOptions().samples;
    std::uint64_t seed = LadderOptions().seed;
    bool extremes = false, noSpeed = false;
};

EquationReport runEquations(const ValidateArguments& options, Progress& progress)
{
    EquationOptions chosen;
    if (!options.equation.empty()) chosen.equation = options.equation;
    chosen.measureSpeed = !options.noSpeed;
    chosen.progress = [&](const std::string& what, double fraction) { progress.show("equations: " + what, fraction); };
    return checkEquations(chosen);
}

LadderScene runLadder(const ValidateArguments& options, const Scene& scene, Progress& progress)
{
    const Settings settings = chosenSettings(options);
    const IVec2 size = chosenSize(options);
    LadderOptions chosen;
    chosen.width = size.x;
    chosen.height = size.y;
    chosen.samples = options.samples;
    chosen.seed = options.seed;
    chosen.progress = [&](const std::string& what, double fraction) { progress.show("ladder of " + scene.name + ": " + what, fraction); };
    return climbLadder(scene, chosenCamera(scene, options), analyseRequirements(scene, settings.force), settings, chosen);
}

/// The scene asked for, or else one of each kind that is built in.
std::vector<LadderScene> runLadders(const ValidateArguments& options, Progress& progress)
{
    if (!options.scene.empty() || !options.view.empty()) return {runLadder(options, loadChosenScene(options), progress)};
    std::vector<LadderScene> ladders;
    for (const char* name : {"cornell-box", "two-rooms", "atrium"}) ladders.push_back(runLadder(options, loadScene(name, {}), progress));
    return ladders;
}

std::string pageOf(const std::vector<ValidationPart>& parts)
{
    HtmlPage page{"lrsm validate", "", "", chartStyle(), chartScript()};
    for (const ValidationPart& part : parts) {
        if (part.name != "ladder") page.summary += part.verdict + " ";  // a ladder's verdict stands at its own section
        page.bodyHtml += part.html;
    }
    return htmlPage(page);
}

void writeResults(const std::string& path, const std::vector<ValidationPart>& parts, const Json& json)
{
    OutputFolder folder(path);
    folder.write("validate.json", jsonText(json));
    folder.write("report.html", pageOf(parts));
    for (const ValidationPart& part : parts)
        for (const auto& [name, text] : part.csv) folder.write(name, text);
    folder.commit();
}

/// What says nothing beside --vectors and --against.
void refuseBesideVectors(const ValidateArguments& options)
{
    const char* name = options.against.empty() ? "--vectors" : "--against";
    if (!options.scene.empty() || !options.view.empty()) throw InputError(name, "is about equations, without a scene; leave out SCENE");
    if (options.extremes || !options.only.empty()) throw InputError(name, "has no meaning with --extremes");
    if (options.against.empty() && (!options.output.empty() || !options.junit.empty()))
        throw InputError("--vectors", "writes its own folder and judges nothing; leave out -o and --junit, or add --against");
}

/// Inputs, exact results and what is allowed, for functions that were written elsewhere.
int writeVectors(const ValidateArguments& options)
{
    OutputFolder folder(options.vectors);
    Progress progress(options.quiet);
    progress.show("vectors: searching for the hardest inputs", 0.0);
    const std::vector<VectorSet> sets = makeVectors(options.equation);
    progress.clear();
    writeVectors(folder, sets, LRSM_VERSION);
    folder.commit();
    if (options.quiet) return 0;
    std::size_t outputs = 0, cases = 0;
    for (const VectorSet& set : sets) outputs += set.outputs.size(), cases += set.cases();
    std::cout << options.vectors << ": " << outputs << " outputs of " << sets.size() << " functions, " << cases << " cases; " << kVectorsFile
              << " says what each file is, and what yours are to be called\n";
    return 0;
}

int judgeResults(const ValidateArguments& options)
{
    const std::string folder = options.vectors.empty() ? options.against : options.vectors;
    if (!std::filesystem::exists(std::filesystem::path(folder) / kVectorsFile))
        throw InputError(folder, std::string("holds no ") + kVectorsFile + "; write your results beside the vectors, or say where those are: --vectors DIR");
    std::vector<VectorSet> sets = readVectors(folder);
    if (!options.equation.empty()) keepEquation(sets, options.equation);
    const Judgement judgement = judgeFolder(sets, options.against);
    if (judgement.count(OutputVerdict::missing) == judgement.outputs.size())
        throw InputError(options.against, "holds no result; " + std::string(kVectorsFile) + " says under \"write\" what each is to be called: " +
                                              givenFile(*judgement.outputs.front().output) + (judgement.notes.empty() ? "" : "; " + judgement.notes.front()));

    Json json = {{"version", LRSM_VERSION}};
    const ValidationPart part = describeJudgement(judgement, json["vectors"]);
    json["held"] = part.held;
    if (!options.output.empty()) writeResults(options.output, {part}, json);
    if (!options.junit.empty()) {
        const std::string xml = judgementJUnit(judgement, options.against + " against the exact results");
        writeFileWhole(options.junit, std::as_bytes(std::span(xml.data(), xml.size())));
    }
    if (options.json)
        std::cout << jsonText(json);
    else
        std::cout << (options.quiet ? "" : part.text) << part.verdict << "\n";
    return judgement.exitCode();
}

int runValidate(const ValidateArguments& options)
{
    if (!options.vectors.empty() || !options.against.empty()) {
        refuseBesideVectors(options);
        const ThreadLimit threads(options.threads);
        return options.against.empty() ? writeVectors(options) : judgeResults(options);
    }
    if (!options.junit.empty()) throw InputError("--junit", "reports what --against judges; add --against DIR");
    if (options.extremes && !options.equation.empty()) throw InputError("--equation " + options.equation, "has no meaning with --extremes");
    if (!options.equation.empty() && !options.scene.empty())
        throw InputError("--equation " + options.equation, "is held against its oracle without a scene; leave out SCENE");
    if (!options.only.empty() && !options.extremes) throw InputError("--only " + options.only, "chooses among the extremes; add --extremes");
    if (!options.output.empty()) OutputFolder probe(options.output);  // an hour's work must not end in a folder that cannot be written

    const ThreadLimit threads(options.threads);
    Progress progress(options.quiet);
    Json json = {{"version", LRSM_VERSION}};
    std::vector<ValidationPart> parts;
    if (options.extremes) {
        ExtremesOptions chosen;
        chosen.only = options.only;
        chosen.progress = [&](const std::string& what, double fraction) { progress.show("extremes: " + what, fraction); };
        const ExtremesReport report = runExtremes(chosen);
        if (report.results.empty() && report.curves.empty()) throw InputError("--only " + options.only, "names no group, case or curve of the catalogue");
        parts.push_back(describeExtremes(report, json["extremes"]));
    } else {
        const bool scene = !options.scene.empty() || !options.view.empty();
        if (!scene) parts.push_back(describeEquations(runEquations(options, progress), json["equations"]));
        if (options.equation.empty()) parts.push_back(describeLadders(runLadders(options, progress), json["ladder"]));
    }
    progress.clear();

    const bool held = std::all_of(parts.begin(), parts.end(), [](const ValidationPart& part) { return part.held; });
    json["held"] = held;
    if (!options.output.empty()) writeResults(options.output, parts, json);
    if (options.json)
        std::cout << jsonText(json);
    else if (!options.quiet)
        for (const ValidationPart& part : parts) std::cout << part.text << part.verdict << "\n";
    if (!options.output.empty() && !options.quiet && !options.json) std::cout << options.output << ": report.html, validate.json, CSV\n";
    return held ? 0 : 1;
}

}  // namespace

Command addValidate(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("validate", "Hold every equation against its oracle, and find where error enters; 1 if a bound is broken");
    const auto options = std::make_shared<ValidateArguments>();
    options->size = std::to_string(LadderOptions().width) + "x" + std::to_string(LadderOptions().height);
    addSceneOptions(*parser, *options);
    addSettingOptions(*parser, *options);
    addPictureOptions(*parser, *options);
    addRunOptions(*parser, *options);
    parser->add_option("-o,--output", options->output, "folder for report.html, validate.json and CSV; they appear whole or not at all");
    parser->add_option("--equation", options->equation, "one equation alone: its number, or sec3, sec5, table1, fig7, base");
    parser->add_option("--vectors", options->vectors,
                       "write inputs, exact results and the allowed error of each equation and elementary function into this folder (docs/vectors.md); with "
                       "--against, read them there");
    parser->add_option("--against", options->against, "judge the results in this folder, computed elsewhere from the inputs of --vectors; 1 if one is wrong");
    parser->add_option("--junit", options->junit, "with --against: file for a JUnit report");
    parser->add_option("--samples", options->samples, "cone samples of the error ladder")->check(CLI::Range(1, 1000000))->capture_default_str();
    parser->add_option("--seed", options->seed, "chooses which")->capture_default_str();
    parser->add_flag("--extremes", options->extremes, "the catalogue of extreme inputs instead");
    parser->add_option("--only", options->only, "with --extremes: cases and curves whose group or name contains this");
    parser->add_flag("--no-speed", options->noSpeed, "do not measure times");
    return {parser, [options] { return runValidate(*options); }};
}

}  // namespace lrsm
