#include "apps/common/commands.h"
#include "apps/common/common_options.h"
#include "apps/common/describe.h"
#include "apps/compare/compare_layer.h"
#include "apps/compare/compare_sequence.h"
#include "core/base/errors.h"
#include "core/base/output_folder.h"
#include "core/base/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

struct CompareArguments {
    std::string test, reference, output, regions = "4x4", exposure = "auto", flipExposures = "auto";
    std::vector<std::string> layers, failAbove, failBelow;
    double pixelsPerDegree = kFlipPixelsPerDegree;
    bool sequence = false, allowNan = false, allPixels = false, quiet = false, json = false;
};

struct Side {
    std::string path;
    LayeredImage image;
};

/// A picture, or a folder with image.exr.
Side readSide(const std::string& path)
{
    std::error_code ignored;
    Side side{std::filesystem::is_directory(path, ignored) ? (std::filesystem::path(path) / "image.exr").string() : path, {}};
    side.image = readImage(side.path);
    return side;
}

bool sceneReferred(const std::string& path)
{
    const std::string extension = std::filesystem::path(path).extension().string();
    for (const char* integer : {".png", ".PNG", ".jpg", ".jpeg", ".bmp", ".tga"})
        if (extension == integer) return false;
    return true;
}

CompareSettings chosenSettings(const CompareArguments& options, bool bothSceneReferred)
{
    CompareSettings settings;
    settings.sceneReferred = bothSceneReferred;
    settings.pixelsPerDegree = options.pixelsPerDegree;
    if (!(options.pixelsPerDegree >= 1.0 && options.pixelsPerDegree <= 1000.0)) throw InputError("--ppd", "must be 1 .. 1000 pixels per degree");
    settings.exposureStops = parseExposure(options.exposure);
    char rest = 0;
    if (std::sscanf(options.regions.c_str(), "%dx%d%c", &settings.regionColumns, &settings.regionRows, &rest) != 2 || settings.regionColumns < 1 ||
        settings.regionRows < 1 || settings.regionColumns > 64 || settings.regionRows > 64)
        throw InputError("--regions " + options.regions, "must be COLUMNSxROWS, 1 .. 64 each, as 4x4");
    if (options.flipExposures != "auto") {
        FlipExposures e;
        if (std::sscanf(options.flipExposures.c_str(), "%lf:%lf:%d%c", &e.start, &e.stop, &e.count, &rest) != 3 || !(e.start <= e.stop) || e.count < 1 ||
            e.count > 100)
            throw InputError("--flip-exposures " + options.flipExposures, "must be auto or START:STOP:COUNT in stops, as -2:4:7");
        settings.flipExposures = e;
    }
    return settings;
}

bool isColor(const LayeredImage& image, const std::string& name)
{
    const ImageLayer* layer = image.find(name);
    return layer && (layer->channelNames.size() >= 3 || layer->channelNames.size() == 1);
}

std::string layerList(const LayeredImage& image)
{
    return joined(image.layers, [](const ImageLayer& layer) { return layer.name.empty() ? "RGB" : layer.name; });
}

/// irradiance where both have it, else combined, else what a viewer shows.
std::vector<std::string> chosenLayers(const CompareArguments& options, const Side& test, const Side& reference)
{
    std::vector<std::string> layers = options.layers;
    const auto both = [&](const std::string& name) { return isColor(test.image, name) && isColor(reference.image, name); };
    if (layers.empty()) {
        for (const char* name : {"irradiance", "combined", ""})
            if (layers.empty() && both(name)) layers = {name};
        if (layers.empty())
            throw InputError(test.path, "has no picture layer in common with " + reference.path + " (" + layerList(test.image) + " against " +
                                            layerList(reference.image) + ")");
    }
    if (layers == std::vector<std::string>{"all"}) {
        layers.clear();
        for (const char* name : {"direct", "irradiance", "indirect.diffuse", "indirect.specular", "specular.cone", "combined", "opacity"})
            if (both(name)) layers.push_back(name);
        if (layers.empty()) layers = {""};
    }
    for (std::string& name : layers) {
        if (name == "RGB") name.clear();
        for (const Side* side : {&test, &reference})
            if (!side->image.find(name)) throw InputError(side->path, "has no layer " + (name.empty() ? "RGB" : name) + "; it has " + layerList(side->image));
    }
    return layers;
}

/// Where the eye sees a surface, in either picture; empty when a side does not say.
PixelMask seenPixels(const Side& test, const Side& reference)
{
    PixelMask seen;
    for (const Side* side : {&test, &reference}) {
        if (!side->image.find("depth")) return {};
        const Image<float> depth = scalarLayer(side->image, "depth", side->path);
        if (seen.empty()) seen = PixelMask(depth.width, depth.height);
        for (std::size_t i = 0; i < depth.texels.size(); ++i) seen.texels[i] |= depth.texels[i] != 0.0f;
    }
    return seen;
}

/// Where flat surfaces show, as the first side that has normals and positions says; empty when none has.
PixelMask flatPixels(const Side& test, const Side& reference)
{
    for (const Side* side : {&reference, &test})
        if (side->image.find("normal") && side->image.find("position"))
            return flatParts(rgbLayer(side->image, "normal", side->path), rgbLayer(side->image, "position", side->path));
    return {};
}

/// Sum of the variances that the two sides store; nothing when the reference stores none.
std::optional<Image<Vec3>> varianceOf(const std::string& layer, const Side& test, const Side& reference)
{
    const std::string name = layer.empty() ? "combined.variance" : layer + ".variance";
    if (!reference.image.find(name)) return {};
    Image<Vec3> variance = rgbLayer(reference.image, name, reference.path);
    if (test.image.find(name)) {
        const Image<Vec3> own = rgbLayer(test.image, name, test.path);
        for (std::size_t i = 0; i < variance.texels.size(); ++i) variance.texels[i] += own.texels[i];
    }
    return variance;
}

struct Gate {
    const MetricInfo* metric = nullptr;
    double limit = 0.0;
    bool above = true;
};

std::vector<Gate> parseGates(const CompareArguments& options)
{
    std::vector<Gate> gates;
    for (const bool above : {true, false})
        for (const std::string& text : above ? options.failAbove : options.failBelow) {
            const std::string option = (above ? "--fail-above " : "--fail-below ") + text;
            const std::size_t at = text.find('=');
            const std::string name = text.substr(0, at);
            Gate gate{nullptr, 0.0, above};
            if (at == std::string::npos || !CLI::detail::lexical_cast(text.substr(at + 1), gate.limit) || std::isnan(gate.limit))
                throw InputError(option, "must be metric=value, as rmse=0.25");
            for (const MetricInfo& metric : metricInfos())
                if (metric.name == name) gate.metric = &metric;
            if (!gate.metric) throw InputError(option, "no metric " + name + "; there are " + joined(metricInfos(), &MetricInfo::name));
            if (above && gate.metric->largerIsBetter)
                throw InputError(option, "would fail the better picture: " + name + " grows with likeness; say --fail-below " + text);
            gates.push_back(gate);
        }
    return gates;
}

/// One sentence for each limit that is passed.
std::vector<std::string> failures(const std::vector<Gate>& gates, const LayerComparison& c, bool allowNan)
{
    std::vector<std::string> lines;
    const std::string layer = c.layer.empty() ? "RGB" : c.layer;
    if (!allowNan && c.metrics.notFiniteTest + c.metrics.notFiniteReference > 0)
        lines.push_back(layer + ": " + std::to_string(c.metrics.notFiniteTest) + " pixels of the test and " + std::to_string(c.metrics.notFiniteReference) +
                        " of the reference are NaN or infinite (--allow-nan leaves them out)");
    for (const Gate& gate : gates) {
        const std::optional<double> value = gate.metric->value(c);
        if (!value) continue;
        const bool passes = gate.above ? *value <= gate.limit : *value >= gate.limit;  // NaN fails
        char text[160];
        std::snprintf(text, sizeof text, "%s: %s = %.6g is %s %.6g", layer.c_str(), gate.metric->name.c_str(), *value, gate.above ? "above" : "below",
                      gate.limit);
        if (!passes) lines.push_back(text);
    }
    return lines;
}

void printComparison(const LayerComparison& c)
{
    const Metrics& m = c.metrics;
    std::printf("%s: energy %.4f (R %.4f G %.4f B %.4f)  RMSE/mean %.4f  MAE/mean %.4f  relMSE %.4g  PSNR %.2f dB  SSIM %.4f  FLIP %.4f",
                c.layer.empty() ? "RGB" : c.layer.c_str(), m.energyRatio, m.channelRatio[0], m.channelRatio[1], m.channelRatio[2], m.rmse, m.mae, m.relMse,
                c.psnr, c.ssim, c.flip.mean);
    if (c.band) std::printf("  band %.4f", *c.band);
    if (c.hdrFlip) std::printf("  HDR-FLIP %.4f", c.hdrFlip->mean);
    std::printf("  (%llu pixels)\n", static_cast<unsigned long long>(m.pixels));
    if (c.pixelZ)
        std::printf("  truth's own noise: RMSE/mean %.4f; z per pixel: rms %.3f, largest %.2f; per 8x8 block: rms %.3f, largest %.2f\n", c.pixelZ->noise,
                    c.pixelZ->rms, c.pixelZ->largest, c.blockZ->rms, c.blockZ->largest);
    std::printf("  regions, energy ratio (RMSE):");
    for (const RegionMetrics& r : c.regions) {
        if (r.region.x0 == 0) std::printf("\n   ");
        if (r.pixels > 0)
            std::printf(" %8.3f (%.3f)", r.energyRatio, r.rmse);
        else
            std::printf("        - (  -  )");
    }
    std::printf("\n");
}

/// What the reader is told of how the pictures were read.
std::vector<std::string> notesOf(const Side& test, const Side& reference, const std::vector<std::string>& layers)
{
    std::vector<std::string> notes;
    for (const Side* side : {&test, &reference}) {
        for (const std::string& note : side->image.notes) notes.push_back(side->path + ": " + note);
        for (const std::string& name : layers) {
            const ImageLayer* layer = side->image.find(name);
            const auto& channels = layer->channelNames;
            if (channels.size() > 1 && std::find(channels.begin(), channels.end(), "A") != channels.end())
                notes.push_back(side->path + ": layer " + (name.empty() ? "RGB" : name) + " has an alpha; colours are compared as stored, whatever it says");
        }
    }
    return notes;
}

std::string metadataText(const LayeredImage& image)
{
    std::string text;
    for (const auto& [key, value] : image.metadata)
        if (key.starts_with("lrsm:")) text += key.substr(5) + ": " + value + "\n";
    return text.empty() ? "(none stored)" : text;
}

void writeResults(const CompareArguments& options, const Side& test, const Side& reference, const std::vector<LayerComparison>& comparisons, const Json& json)
{
    OutputFolder folder(options.output);
    Comparison report{test.path + " against " + reference.path,
                      "",
                      {},
                      {{"Test: " + test.path, metadataText(test.image)}, {"Reference: " + reference.path, metadataText(reference.image)}}};
    const auto& failed = json["failures"];
    report.summary = failed.empty() ? "No limit was passed." : "Failed: ";
    for (const auto& line : failed) report.summary += line.get<std::string>() + ". ";
    for (const auto& note : json["notes"]) report.summary += " Note: " + note.get<std::string>() + ".";
    for (const LayerComparison& c : comparisons) {
        report.layers.push_back(comparisonSection(c));
        for (const NamedPicture& picture : comparisonPictures(c))
            folder.write((c.layer.empty() ? "RGB" : c.layer) + "." + picture.name + ".png", encodePng(picture.picture));
    }
    folder.write("report.html", comparisonPage(report));
    folder.write("compare.json", jsonText(json));
    folder.commit();
    if (!options.quiet && !options.json) std::cout << folder.path().string() << ": report.html, compare.json, PNGs\n";
}

int compareFrames(const CompareArguments& options)
{
    if (!options.failBelow.empty()) throw InputError("--fail-below", "is of single pictures; a sequence's metrics are all better when smaller");
    return compareSequences({.test = options.test,
                             .reference = options.reference,
                             .output = options.output,
                             .layers = options.layers,
                             .failAbove = options.failAbove,
                             .exposureStops = parseExposure(options.exposure),
                             .allPixels = options.allPixels,
                             .allowNan = options.allowNan,
                             .quiet = options.quiet,
                             .json = options.json});
}

int runCompare(const CompareArguments& options)
{
    if (options.sequence) return compareFrames(options);
    const std::vector<Gate> gates = parseGates(options);
    if (!options.output.empty()) {
        const OutputFolder writable(options.output);
    }
    const Side test = readSide(options.test), reference = readSide(options.reference);
    if (test.image.width != reference.image.width || test.image.height != reference.image.height)
        throw InputError(test.path, "is " + std::to_string(test.image.width) + "x" + std::to_string(test.image.height) + ", but " + reference.path + " is " +
                                        std::to_string(reference.image.width) + "x" + std::to_string(reference.image.height) + "; render both at one size");
    const CompareSettings settings = chosenSettings(options, sceneReferred(test.path) && sceneReferred(reference.path));
    const PixelMask seen = options.allPixels ? PixelMask() : seenPixels(test, reference);

    std::vector<LayerComparison> comparisons;
    Json json = {{"program", "lrsm"},
                 {"version", LRSM_VERSION},
                 {"command", "compare"},
                 {"test", test.path},
                 {"reference", reference.path},
                 {"size", {test.image.width, test.image.height}},
                 {"pixels_per_degree", settings.pixelsPerDegree},
                 {"notes", Json::array()},
                 {"layers", Json::array()},
                 {"failures", Json::array()}};
    const PixelMask flat = flatPixels(test, reference);
    const std::vector<std::string> layers = chosenLayers(options, test, reference);
    json["notes"] = notesOf(test, reference, layers);
    for (const std::string& layer : layers) {
        const Image<Vec3> referencePicture = rgbLayer(reference.image, layer, reference.path), testPicture = rgbLayer(test.image, layer, test.path);
        comparisons.push_back(compareLayer(layer, referencePicture, testPicture, varianceOf(layer, test, reference), seen, settings));
        if (!flat.empty()) comparisons.back().band = bandError(referencePicture, testPicture, flat);
        json["layers"].push_back(comparisonJson(comparisons.back()));
        for (const std::string& line : failures(gates, comparisons.back(), options.allowNan)) json["failures"].push_back(line);
    }
    if (options.json) {
        std::cout << jsonText(json);
    } else if (!options.quiet) {
        for (const auto& note : json["notes"]) std::printf("note: %s\n", note.get<std::string>().c_str());
        for (const LayerComparison& c : comparisons) printComparison(c);
    }
    std::fflush(stdout);
    for (const Gate& gate : gates)
        if (std::none_of(comparisons.begin(), comparisons.end(), [&](const LayerComparison& c) { return gate.metric->value(c).has_value(); }))
            throw InputError("limit on " + gate.metric->name, "no compared layer has it (z needs a reference that stores variances, hdr_flip an EXR)");
    if (!options.output.empty()) writeResults(options, test, reference, comparisons, json);
    for (const auto& line : json["failures"]) std::cerr << "lrsm: " << line.get<std::string>() << "\n";
    return json["failures"].empty() ? 0 : 1;
}

}  // namespace

Command addCompare(CLI::App& program)
{
    CLI::App* parser = program.add_subcommand("compare", "How far a picture is from the reference: numbers, maps, one HTML file");
    const auto options = std::make_shared<CompareArguments>();
    parser->add_option("TEST", options->test, "folder of a render, or an EXR or PNG")->required();
    parser->add_option("REFERENCE", options->reference, "folder of a reference, or an EXR or PNG of the same size")->required();
    parser->add_option("-o,--output", options->output, "folder for report.html, compare.json and maps");
    parser
        ->add_option("--layer", options->layers,
                     "layer to compare, repeatable; RGB: the unnamed one; all: every one both have. By default irradiance, else combined, else RGB")
        ->allow_extra_args(false);
    parser->add_flag("--sequence", options->sequence,
                     "TEST and REFERENCE are folders of frames (render --frames): F, F_e, V, J, curves over time, worst frame; docs/sequences.md. --fail-above "
                     "then takes f, "
                     "fe, v and j");
    parser->add_option("--regions", options->regions, "COLUMNSxROWS of the table of regions")->capture_default_str();
    std::string metrics;
    for (const MetricInfo& metric : metricInfos()) metrics += "\n  " + metric.name + ": " + metric.meaning;
    parser->add_option("--fail-above", options->failAbove, "metric=value, repeatable: exit code 1 where a layer's metric is above. Metrics:" + metrics)
        ->allow_extra_args(false);
    parser->add_option("--fail-below", options->failBelow, "metric=value, repeatable: for psnr and ssim")->allow_extra_args(false);
    parser->add_option("--exposure", options->exposure, "stops for the pictures, LDR-FLIP, PSNR and SSIM; auto: from the reference (0 for PNG)")
        ->capture_default_str();
    parser->add_option("--flip-exposures", options->flipExposures, "START:STOP:COUNT of HDR-FLIP; auto: from the reference, as its paper does")
        ->capture_default_str();
    parser->add_option("--ppd", options->pixelsPerDegree, "pixels per degree of FLIP's viewer")->capture_default_str();
    parser->add_flag("--allow-nan", options->allowNan, "pixels that are not finite are left out instead of failing");
    parser->add_flag("--all-pixels", options->allPixels, "count pixels where the eye sees nothing, too");
    parser->add_flag("-q,--quiet", options->quiet, "no table");
    parser->add_flag("--json", options->json, "JSON on standard output");
    return {parser, [options] { return runCompare(*options); }};
}

}  // namespace lrsm
