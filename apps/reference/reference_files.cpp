#include "apps/reference/reference_files.h"

#include "apps/common/describe.h"
#include "core/base/errors.h"
#include "core/base/text.h"
#include "core/imageio/image_io.h"

#include <charconv>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

void addWithVariance(LayeredImage& image, const std::string& name, const Image<Vec3>& mean, const Image<Vec3>& variance)
{
    if (mean.empty()) return;
    addLayer(image, name, mean);
    if (!variance.empty()) addLayer(image, name + ".variance", variance);
}

LayeredImage layersOf(const ReferenceFrame& frame, const SeenLayers& seen, const Checkpoint& checkpoint)
{
    LayeredImage image;
    addLayer(image, "", frame.combined);  // what a viewer shows by default
    addLayer(image, "direct", frame.direct);
    addWithVariance(image, "irradiance", frame.irradiance, frame.irradianceVariance);
    addWithVariance(image, "indirect.diffuse", frame.indirectDiffuse, frame.indirectDiffuseVariance);
    addWithVariance(image, "indirect.specular", frame.indirectSpecular, frame.indirectSpecularVariance);
    addWithVariance(image, "specular.cone", frame.specularCone, frame.specularConeVariance);
    addWithVariance(image, "combined", frame.combined, frame.combinedVariance);
    addLayer(image, "albedo", seen.albedo);
    addLayer(image, "normal", seen.normal);
    addLayer(image, "position", seen.position);
    addLayer(image, "depth", seen.depth, "Z");
    addLayer(image, "opacity", frame.opacity);
    if (!frame.opacityVariance.empty()) addLayer(image, "opacity.variance", frame.opacityVariance);

    image.metadata = {{"lrsm:command", "reference"}, {"lrsm:samples", describeRanges(checkpoint.state.sums.ranges)}};
    for (const auto& [name, value] : checkpoint.identity) image.metadata.emplace_back("lrsm:" + name, value);
    return image;
}

bool anyLight(const Image<Vec3>& picture)
{
    return std::any_of(picture.texels.begin(), picture.texels.end(), [](const Vec3& v) { return v != Vec3(0.0f); });
}

}  // namespace

SeenLayers seenLayers(const Scene& scene, const PrimaryHits& primary)
{
    const int width = primary.covered.width, height = primary.covered.height;
    SeenLayers seen{primary.direct, {width, height}, {width, height}, {width, height}, primary.depth};
    for (std::size_t i = 0; i < primary.covered.texels.size(); ++i) {
        seen.albedo.texels[i] = primary.surface.texels[i].albedo;
        seen.normal.texels[i] = primary.surface.texels[i].normal;
        seen.position.texels[i] = primary.surface.texels[i].position;
    }
    seen.position = worldPositions(scene, seen.position, seen.depth);
    return seen;
}

SeenLayers readSeenLayers(const std::string& exrPath)
{
    const LayeredImage image = readImage(exrPath);
    return {rgbLayer(image, "direct", exrPath), rgbLayer(image, "albedo", exrPath), rgbLayer(image, "normal", exrPath), rgbLayer(image, "position", exrPath),
            scalarLayer(image, "depth", exrPath)};
}

SampleRange parseSamples(const std::string& text)
{
    SampleRange range;
    const char *begin = text.data(), *end = begin + text.size();
    const auto first = std::from_chars(begin, end, range.begin);
    const bool colon = first.ec == std::errc() && first.ptr != end && *first.ptr == ':';
    if (colon) {
        const auto second = std::from_chars(first.ptr + 1, end, range.end);
        if (second.ec == std::errc() && second.ptr == end && range.begin < range.end && range.end <= std::uint64_t(1) << 32) return range;
    }
    throw InputError("--samples " + text, "must be A:B with A < B <= 2^32: samples A, A + 1, ... B - 1");
}

std::string describeRanges(const std::vector<SampleRange>& ranges)
{
    return joined(ranges, [](const SampleRange& range) { return std::to_string(range.begin) + ":" + std::to_string(range.end); });
}

ReferenceFrame writeReference(OutputFolder& folder, const Checkpoint& checkpoint, const SeenLayers& seen, const Json& json, std::optional<float> exposureStops)
{
    const ReferenceFrame frame = resolveFrame(checkpoint.state.sums, checkpoint.unit, seen.direct, seen.albedo);
    const float stops = exposureStops ? *exposureStops : automaticExposure(frame.combined);
    Json complete = json;
    complete["exposure_stops"] = stops;

    folder.write("image.exr", encodeExr(layersOf(frame, seen, checkpoint)));
    folder.write("image.png", encodePng(tonemap(frame.combined, stops)));
    folder.write("direct.png", encodePng(tonemap(frame.direct, stops)));
    folder.write("irradiance.png", encodePng(tonemap(onWhite(frame.irradiance), stops)));
    folder.write("indirect.diffuse.png", encodePng(tonemap(frame.indirectDiffuse, stops)));
    if (anyLight(frame.indirectSpecular)) folder.write(kSpecularPicture, encodePng(tonemap(frame.indirectSpecular, stops)));
    folder.write("frame.json", jsonText(complete));
    folder.write(kSamplesFile, encodeCheckpoint(checkpoint));
    return frame;
}

}  // namespace lrsm
