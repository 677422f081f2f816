#include "apps/common/commands.h"
#include "apps/common/describe.h"
#include "apps/common/earlier_result.h"
#include "apps/reference/reference_files.h"
#include "core/base/file.h"
#include "core/base/json_reader.h"

#include <filesystem>
#include <iostream>
#include <memory>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

struct MergeArguments {
    std::vector<std::string> folders;
    std::string output;
    bool allowGaps = false, quiet = false, json = false;
};

Checkpoint readFinished(const std::string& folder)
{
    const std::string file = (std::filesystem::path(folder) / kSamplesFile).string();
    Checkpoint found = decodeCheckpoint(readFile(file), file);
    if (!found.state.finished()) throw InputError(folder, "holds an unfinished render; finish it with lrsm reference --resume first");
    return found;
}

Json readFrameJson(const std::string& folder)
{
    const std::string file = (std::filesystem::path(folder) / "frame.json").string();
    Json json = parseJson(readFile(file), file);
    if (!json.is_object()) throw InputError(file, "is no frame.json");
    return json;
}

/// Adds what `other` counted to `json`.
void addCounts(Json& json, const Json& other, const std::string& key)
{
    if (!json.contains(key) || !other.contains(key) || !json[key].is_object()) return;
    for (auto& [name, value] : json[key].items()) {
        if (!value.is_number() || !other[key].contains(name) || !other[key][name].is_number()) continue;
        if (value.is_number_integer())
            value = value.get<std::uint64_t>() + other[key][name].get<std::uint64_t>();
        else
            value = value.get<double>() + other[key][name].get<double>();
    }
}

int runMerge(const MergeArguments& options)
{
    if (options.output.empty()) throw InputError("merge", "needs -o FOLDER");
    {
        const OutputFolder writable(options.output);
    }
    refuseOtherResult(options.output, "reference");

    Checkpoint merged = readFinished(options.folders[0]);
    Json json = readFrameJson(options.folders[0]);
    for (std::size_t i = 1; i < options.folders.size(); ++i) {
        const std::string& folder = options.folders[i];
        const Checkpoint next = readFinished(folder);
        requireSameIdentity(merged.identity, options.folders[0], next.identity, folder);
        if (next.state.sums.sums.size() != merged.state.sums.sums.size() || next.unit != merged.unit)
            throw InputError(folder, "holds another picture than " + options.folders[0]);
        mergeSums(merged.state.sums, next.state.sums, folder.c_str());
        merged.state.rays += next.state.rays;
        merged.state.faults += next.state.faults;
        addCounts(json, readFrameJson(folder), "rays");
    }
    const std::string ranges = describeRanges(merged.state.sums.ranges);
    if (merged.state.sums.ranges.size() > 1 && !options.allowGaps)
        throw InputError("merge", "the samples leave gaps: " + ranges + "; render what is missing, or --allow-gaps");

    json["samples"] = merged.state.sums.sampleCount();
    json["sample_ranges"] = ranges;
    json["not_finite_samples"] = merged.state.faults.notFinite;
    json["clamped_samples"] = merged.state.faults.clamped;
    json.erase("bare_loop");
    if (json.contains("rays") && json["rays"].value("seconds", 0.0) > 0.0)
        json["rays"]["million_per_second"] = json["rays"].value("total", 0.0) / json["rays"].value("seconds", 0.0) * 1e-6;

    OutputFolder folder(options.output);
    writeReference(folder, merged, readSeenLayers((std::filesystem::path(options.folders[0]) / "image.exr").string()), json, {});
    folder.commit();
    if (options.json)
        std::cout << jsonText(json);
    else if (!options.quiet)
        std::cout << folder.path().string() << ": samples " << ranges << "\n";
    return 0;
}

}  // namespace

Command addMerge(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("merge", "Join sample ranges of one reference, to the bits of rendering them at once");
    const auto options = std::make_shared<MergeArguments>();
    parser->add_option("FOLDER", options->folders, "folders written by lrsm reference")->required()->expected(1, 1 << 20);
    parser->add_option("-o,--output", options->output, "folder for the results");
    parser->add_flag("--allow-gaps", options->allowGaps, "join ranges that do not touch");
    parser->add_flag("-q,--quiet", options->quiet, "no summary");
    parser->add_flag("--json", options->json, "JSON on standard output");
    return {parser, [options] { return runMerge(*options); }};
}

}  // namespace lrsm
