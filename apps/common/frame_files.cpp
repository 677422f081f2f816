#include "apps/common/frame_files.h"

#include "apps/common/describe.h"
#include "core/imageio/image_io.h"
#include "core/scene/exposure.h"
#include "core/settings/settings_table.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

Json passesJson(const Frame& frame)
{
    Json passes = Json::array();
    for (const PassReport& pass : frame.passes)
        passes.push_back({{"name", pass.name},
                          {"milliseconds", pass.milliseconds},
                          {"cpu_milliseconds", pass.cpuMilliseconds},
                          {"bytes", pass.bytes},
                          {"gpu_format_bytes", pass.gpuBytes},
                          {"sha256", pass.sha256},
                          {"resident", pass.traits.resident},
                          {"non_finite", pass.nonFinite},
                          {"counters", countersJson(pass.counters)}});
    return passes;
}

float exposureOf(const Frame& frame, const FrameRecord& record)
{
    return record.exposureStops ? *record.exposureStops : automaticExposure(frame.combined);
}

LayeredImage layersOf(const Frame& frame, const Scene& scene, const Json& json)
{
    LayeredImage image;
    addLayer(image, "", frame.combined);  // what a viewer shows by default
    addLayer(image, "direct", frame.direct);
    addLayer(image, "irradiance", frame.irradiance);
    addLayer(image, "indirect.diffuse", frame.indirectDiffuse);
    addLayer(image, "indirect.specular", frame.indirectSpecular);
    addLayer(image, "combined", frame.combined);
    addLayer(image, "albedo", frame.gbuffer.albedo);
    addLayer(image, "normal", frame.gbuffer.normal);
    addLayer(image, "position", worldPositions(scene, frame.gbuffer.position, frame.gbuffer.depthLinear));
    addLayer(image, "depth", frame.gbuffer.depthLinear, "Z");
    addLayer(image, "opacity", frame.opacity);
    image.metadata = {{"lrsm:version", json["version"].get<std::string>()},
                      {"lrsm:command", "render"},
                      {"lrsm:scene", json["scene"]["name"].get<std::string>()},
                      {"lrsm:scene_sha256", json["scene"]["sha256"].get<std::string>()},
                      {"lrsm:camera", json["camera"].dump(-1, ' ', false, Json::error_handler_t::replace)},
                      {"lrsm:settings", json["settings"].dump()}};
    return image;
}

Image<Rgb8> depthPicture(const Image<float>& depth)
{
    float farthest = 0.0f;
    for (const float value : depth.texels)
        if (std::isfinite(value)) farthest = std::max(farthest, value);
    return falseColor(depth, 0.0f, farthest);
}

}  // namespace

Json frameJson(const Frame& frame, const FrameRecord& record)
{
    double milliseconds = 0.0;
    for (const PassReport& pass : frame.passes) milliseconds += pass.milliseconds;
    return {{"program", "lrsm"},
            {"version", LRSM_VERSION},
            {"command", "render"},
            {"size", {frame.combined.width, frame.combined.height}},
            {"exposure_stops", exposureOf(frame, record)},
            {"pre_exposure", preExposureOf(record.scene)},
            {"preset", record.preset},
            {"settings", settingsToJson(record.settings)},
            {"visibility", record.visibility},
            {"radiance", record.radiance},
            {"scene", sceneJson(record.scene, record.sceneHash)},
            {"camera", cameraJson(record.camera, Angle::degrees, record.scene.origin)},
            {"requires", requirementsJson(frame.needs)},
            {"milliseconds", milliseconds},
            {"passes", passesJson(frame)},
            {"memory", memoryJson(record.memory)}};
}

void writeFrame(OutputFolder& folder, const Frame& frame, const FrameRecord& record, const Json& json)
{
    const float stops = exposureOf(frame, record);
    const auto png = [&](const std::string& name, const Image<Rgb8>& picture) { folder.write(name + ".png", encodePng(picture)); };

    folder.write("image.exr", encodeExr(layersOf(frame, record.scene, json)));
    png("image", tonemap(frame.combined, stops));
    png("direct", tonemap(frame.direct, stops));
    png("irradiance", tonemap(onWhite(frame.irradiance), stops));
    png("indirect.diffuse", tonemap(frame.indirectDiffuse, stops));
    png("indirect.specular", tonemap(frame.indirectSpecular, stops));
    png("albedo", tonemap(frame.gbuffer.albedo, 0.0f));
    png("normal", normalColor(frame.gbuffer.normal));
    png("depth", depthPicture(frame.gbuffer.depthLinear));
    png("opacity", falseColor(frame.opacity, 0.0f, 1.0f));
    folder.write("frame.json", jsonText(json));
}

}  // namespace lrsm
