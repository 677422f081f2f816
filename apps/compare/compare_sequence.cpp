#include "apps/compare/compare_sequence.h"

#include "apps/common/describe.h"
#include "apps/common/progress.h"
#include "apps/compare/sequence_files.h"
#include "apps/compare/sequence_page.h"
#include "core/base/errors.h"
#include "core/base/output_folder.h"
#include "core/base/text.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kShownWidth = 320;               // pixels of a frame in the page
constexpr std::size_t kMostShownFrames = 240;  // of a longer sequence every so-manieth is shown
constexpr float kErrorLimit = 1.0f;            // signed errors end at one mean of the reference
constexpr float kFlickerLimit = 0.1f;          // maps over time at a tenth

struct Limit {
    const char* name;
    std::optional<double> (*value)(const SequenceMetrics&);
};
constexpr Limit kLimits[] = {{"f", [](const SequenceMetrics& m) { return std::optional(m.flicker); }},
                             {"fe", [](const SequenceMetrics& m) { return std::optional(m.flickerOfError); }},
                             {"v", [](const SequenceMetrics& m) { return m.dance; }},
                             {"j", [](const SequenceMetrics& m) { return std::optional(m.jump); }}};

struct SequenceGate {
    const Limit* limit = nullptr;
    double value = 0.0;
};

std::vector<SequenceGate> parseSequenceGates(const std::vector<std::string>& texts)
{
    std::vector<SequenceGate> gates;
    for (const std::string& text : texts) {
        const std::size_t at = text.find('=');
        SequenceGate gate;
        for (const Limit& limit : kLimits)
            if (limit.name == text.substr(0, at)) gate.limit = &limit;
        if (!gate.limit || at == std::string::npos || !CLI::detail::lexical_cast(text.substr(at + 1), gate.value) || std::isnan(gate.value))
            throw InputError("--fail-above " + text, "must be metric=value of a sequence, as fe=0.01; there are " + joined(kLimits, &Limit::name));
        gates.push_back(gate);
    }
    return gates;
}

bool anyLight(const LayeredImage& image, const std::string& layer, const std::string& path)
{
    const Image<Vec3> picture = rgbLayer(image, layer, path);
    return std::any_of(picture.texels.begin(), picture.texels.end(), [](const Vec3& v) { return v != Vec3(0.0f); });
}

/// irradiance, and indirect.specular where either has any, those that both have; else what a viewer shows.
std::vector<std::string> sequenceLayers(const SequenceComparison& options, const FramePair& first)
{
    std::vector<std::string> layers = options.layers;
    const auto both = [&](const std::string& name) { return first.test.find(name) && first.reference.find(name); };
    if (layers.empty() && both("irradiance")) layers = {"irradiance"};
    if (options.layers.empty() && both("indirect.specular") &&
        (anyLight(first.test, "indirect.specular", first.testPath) || anyLight(first.reference, "indirect.specular", first.referencePath)))
        layers.emplace_back("indirect.specular");
    if (layers.empty()) layers = {""};
    for (std::string& name : layers) {
        if (name == "RGB") name.clear();
        for (const bool ofTest : {true, false})
            if (!(ofTest ? first.test : first.reference).find(name))
                throw InputError(ofTest ? first.testPath : first.referencePath, "has no layer " + (name.empty() ? "RGB" : name));
    }
    return layers;
}

std::string layerTitle(const std::string& layer)
{
    return layer.empty() ? "RGB" : layer;
}

Image<float> narrowed(const Image<double>& values)
{
    Image<float> result(values.width, values.height);
    for (std::size_t i = 0; i < values.texels.size(); ++i) result.texels[i] = float(values.texels[i]);
    return result;
}

Image<Rgb8> errorPicture(const Image<Vec3>& test, const Image<Vec3>& reference, double mean)
{
    Image<float> error(test.width, test.height);
    for (std::size_t i = 0; i < error.texels.size(); ++i)
        error.texels[i] = float((double(luminance(test.texels[i])) - double(luminance(reference.texels[i]))) / (mean > 0.0 ? mean : 1.0));
    return signedFalseColor(error, kErrorLimit);
}

/// Seconds; where the files do not say, its number.
double timeOfFrame(const SequenceFiles& files, int frame)
{
    const auto time = files.times.find(frame);
    return time == files.times.end() ? double(frame) : time->second;
}

Json momentJson(int frame, double time, const MomentMetrics& m)
{
    return {{"frame", frame},
            {"time", time},
            {"mean_test", numberJson(m.meanTest)},
            {"mean_reference", numberJson(m.meanReference)},
            {"rmse_over_mean", numberJson(m.rmse)},
            {"f", numberJson(m.flicker)},
            {"f_reference", numberJson(m.flickerReference)},
            {"fe", numberJson(m.flickerOfError)},
            {"jump", numberJson(m.jump)}};
}

Json layerJson(const SequenceSection& section, const SequenceFiles& test)
{
    const SequenceMetrics& m = section.metrics;
    Json json = {{"layer", section.layer},
                 {"mean_reference", m.meanReference},
                 {"f", numberJson(m.flicker)},
                 {"f_reference", numberJson(m.flickerReference)},
                 {"fe", numberJson(m.flickerOfError)},
                 {"v", m.dance ? Json(*m.dance) : Json()},
                 {"still_share", m.stillShare},
                 {"j", numberJson(m.jump)},
                 {"followed_share", m.followedShare},
                 {"worst_frame", section.frames[m.worstFlicker]},
                 {"worst_jump_into", section.frames[m.worstJump]},
                 {"frames", Json::array()}};
    for (std::size_t t = 0; t < section.frames.size(); ++t)
        json["frames"].push_back(momentJson(section.frames[t], timeOfFrame(test, section.frames[t]), m.moments[t]));
    return json;
}

/// Both sequences, every frame read once for all layers.
std::vector<SequenceSection> measureAll(const SequenceComparison& options, const SequenceFiles& test, const SequenceFiles& reference,
                                        const std::vector<int>& frames, std::vector<std::uint64_t>& notFinitePixels, Progress& progress)
{
    std::vector<std::string> layers;
    std::vector<SequenceMeter> meters;
    int width = 0, height = 0;
    for (std::size_t t = 0; t < frames.size(); ++t) {
        progress.show("measuring", double(t) / double(frames.size()));
        const FramePair pair = readFrame(test, reference, frames[t]);
        if (t == 0) {
            layers = sequenceLayers(options, pair);
            meters.resize(layers.size());
            notFinitePixels.assign(layers.size(), 0);
            width = pair.test.width, height = pair.test.height;
        }
        if (pair.test.width != width || pair.test.height != height) throw InputError(pair.testPath, "has another size than the first frame");
        for (std::size_t k = 0; k < layers.size(); ++k) {
            meters[k].add(momentOf(pair, layers[k], options.allPixels));
            notFinitePixels[k] += notFinite(pair, layers[k]);
        }
    }
    std::vector<SequenceSection> sections;
    for (std::size_t k = 0; k < layers.size(); ++k) sections.push_back({layerTitle(layers[k]), meters[k].finish(), frames, {}, {}});
    return sections;
}

/// Frames of the page, and the pictures of the worst one.
void addPictures(const SequenceComparison& options, const SequenceFiles& test, const SequenceFiles& reference, std::vector<SequenceSection>& sections,
                 OutputFolder& folder, Progress& progress)
{
    const std::vector<int>& frames = sections.front().frames;
    const std::size_t every = (frames.size() + kMostShownFrames - 1) / kMostShownFrames;
    std::vector<float> stops(sections.size(), 0.0f);
    for (std::size_t t = 0; t < frames.size(); ++t) {
        progress.show("drawing", double(t) / double(frames.size()));
        const bool worst =
            std::any_of(sections.begin(), sections.end(), [&](const SequenceSection& s) { return s.metrics.worstFlicker == t || s.metrics.worstJump == t; });
        if (t % every != 0 && !worst) continue;
        const FramePair pair = readFrame(test, reference, frames[t]);
        for (std::size_t k = 0; k < sections.size(); ++k) {
            SequenceSection& section = sections[k];
            const std::string layer = section.layer == "RGB" ? "" : section.layer;
            const Image<Vec3> x = rgbLayer(pair.test, layer, pair.testPath), r = rgbLayer(pair.reference, layer, pair.referencePath);
            if (t == 0) stops[k] = options.exposureStops ? *options.exposureStops : automaticExposure(r);
            const double mean = section.metrics.meanReference;
            const Image<Vec3> smallX = shrunk(x, kShownWidth), smallR = shrunk(r, kShownWidth);
            section.shown.push_back({frames[t], timeOfFrame(test, frames[t]), encodePng(tonemap(smallX, stops[k])), encodePng(tonemap(smallR, stops[k])),
                                     encodePng(errorPicture(smallX, smallR, mean))});
            if (section.metrics.worstFlicker != t) continue;
            const std::vector<std::byte> error = encodePng(errorPicture(x, r, mean));
            folder.write(section.layer + ".worst.test.png", encodePng(tonemap(x, stops[k])));
            folder.write(section.layer + ".worst.reference.png", encodePng(tonemap(r, stops[k])));
            folder.write(section.layer + ".worst.signed.png", error);
            section.maps.push_back({"frame " + std::to_string(frames[t]) + ", where most of the error flickers: signed error", error});
        }
    }
    for (SequenceSection& section : sections) {
        const auto map = [&](const char* name, const std::string& title, const Image<double>& values) {
            const std::vector<std::byte> png = encodePng(falseColor(narrowed(values), 0.0f, kFlickerLimit));
            folder.write(section.layer + "." + name + ".png", png);
            section.maps.push_back({title + ": dark blue 0, yellow a tenth of the mean or more", png});
        };
        map("flicker", "mean |D2 e| of each pixel", section.metrics.flickerMap);
        map("flicker.reference", "mean |D2 r|, the reference's own", section.metrics.flickerReferenceMap);
        if (section.metrics.dance) map("dance", "standard deviation in time of the test where the reference stands still", section.metrics.danceMap);
    }
}

Json notesOf(const SequenceFiles& test, const SequenceFiles& reference, std::size_t common)
{
    Json notes = Json::array();
    for (const SequenceFiles* side : {&test, &reference})
        if (side->pictures.size() > common)
            notes.push_back(std::to_string(side->pictures.size() - common) + " frames of " + side->folder + " have no counterpart and are left out");
    return notes;
}

}  // namespace

int compareSequences(const SequenceComparison& options)
{
    const std::vector<SequenceGate> gates = parseSequenceGates(options.failAbove);
    std::optional<OutputFolder> folder;
    if (!options.output.empty()) folder.emplace(options.output);
    const SequenceFiles test = readSequence(options.test), reference = readSequence(options.reference);
    const std::vector<int> frames = commonFrames(test, reference);
    Progress progress(options.quiet);
    std::vector<std::uint64_t> notFinitePixels;
    std::vector<SequenceSection> sections = measureAll(options, test, reference, frames, notFinitePixels, progress);

    Json json = {{"program", "lrsm"},
                 {"version", LRSM_VERSION},
                 {"command", "compare"},
                 {"sequence", true},
                 {"test", options.test},
                 {"reference", options.reference},
                 {"notes", notesOf(test, reference, frames.size())},
                 {"layers", Json::array()},
                 {"failures", Json::array()}};
    for (std::size_t k = 0; k < sections.size(); ++k) {
        const SequenceSection& section = sections[k];
        json["layers"].push_back(layerJson(section, test));
        if (notFinitePixels[k] > 0 && !options.allowNan)
            json["failures"].push_back(section.layer + ": " + std::to_string(notFinitePixels[k]) + " pixels are NaN or infinite (--allow-nan leaves them out)");
        for (const SequenceGate& gate : gates) {
            const std::optional<double> value = gate.limit->value(section.metrics);
            if (value && !(*value <= gate.value))
                json["failures"].push_back(section.layer + ": " + gate.limit->name + " = " + numberText(6, *value) + " is above " + numberText(6, gate.value));
        }
    }
    if (folder) {
        addPictures(options, test, reference, sections, *folder, progress);
        SequenceReport report{options.test + " against " + options.reference, "", sections};
        report.summary = json["failures"].empty() ? "No limit was passed." : "Failed: ";
        for (const auto& line : json["failures"]) report.summary += line.get<std::string>() + ". ";
        for (const auto& note : json["notes"]) report.summary += " Note: " + note.get<std::string>() + ".";
        folder->write("report.html", sequencePage(report));
        folder->write("compare.json", jsonText(json));
        folder->commit();
    }
    progress.clear();
    if (options.json)
        std::cout << jsonText(json);
    else if (!options.quiet) {
        for (const auto& note : json["notes"]) std::cout << "note: " << note.get<std::string>() << "\n";
        for (const SequenceSection& section : sections) std::cout << textTable(sequenceTable(section));
        if (folder) std::cout << folder->path().string() << ": report.html, compare.json, PNGs\n";
    }
    for (const auto& line : json["failures"]) std::cerr << "lrsm: " << line.get<std::string>() << std::endl;
    return json["failures"].empty() ? 0 : 1;
}

}  // namespace lrsm
