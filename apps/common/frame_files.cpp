#include "apps/common/frame_files.h"

#include "apps/common/caches_picture.h"
#include "apps/common/describe.h"
#include "core/base/parallel.h"
#include "core/imageio/image_io.h"
#include "core/scene/exposure.h"
#include "core/settings/settings_table.h"
#include "voxel/voxelize.h"

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

namespace lrsm {

namespace {

using Json = nlohmann::ordered_json;

Json passesJson(const Frame& frame)
{
    Json passes = Json::array();
    for (const PassReport& pass : frame.passes) {
        passes.push_back({{"name", pass.name},
                          {"milliseconds", pass.milliseconds},
                          {"cpu_milliseconds", pass.cpuMilliseconds},
                          {"bytes", pass.bytes},
                          {"gpu_format_bytes", pass.gpuBytes},
                          {"sha256", pass.sha256},
                          {"resident", pass.traits.resident},
                          {"non_finite", pass.nonFinite},
                          {"counters", countersJson(pass.counters)}});
        if (pass.kept) passes.back()["kept"] = true;
    }
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
    Image<float> object(frame.gbuffer.width, frame.gbuffer.height);  // exact below 2^24
    std::copy(frame.gbuffer.objectId.texels.begin(), frame.gbuffer.objectId.texels.end(), object.texels.begin());
    addLayer(image, "object", object);
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
            {"radiance", record.radiance},
            {"scene", sceneJson(record.scene, record.sceneHash)},
            {"camera", cameraJson(record.camera, Angle::degrees, record.scene.origin)},
            {"voxel_grids", voxelGridsJson(gridsOf(record.scene, record.settings.voxel, record.camera.position), record.scene.origin)},
            {"requires", requirementsJson(frame.needs)},
            {"milliseconds", milliseconds},
            {"passes", passesJson(frame)},
            {"memory", memoryJson(record.memory)}};
}

void writeFrame(OutputFolder& folder, const Frame& frame, const FrameRecord& record, const Json& json)
{
    const float stops = exposureOf(frame, record);
    struct File {
        const char* name;
        std::function<std::vector<std::byte>()> encode;
    };
    const auto png = [](const char* name, auto picture) { return File{name, [=] { return encodePng(picture()); }}; };
    std::vector<File> files = {
        {"image.exr", [&] { return encodeExr(layersOf(frame, record.scene, json)); }},
        png("image.png", [&] { return tonemap(frame.combined, stops); }),
        png("direct.png", [&] { return tonemap(frame.direct, stops); }),
        png("irradiance.png", [&] { return tonemap(onWhite(frame.irradiance), stops); }),
        png("indirect.diffuse.png", [&] { return tonemap(frame.indirectDiffuse, stops); }),
        png("indirect.specular.png", [&] { return tonemap(frame.indirectSpecular, stops); }),
        png("albedo.png", [&] { return tonemap(frame.gbuffer.albedo, 0.0f); }),
        png("normal.png", [&] { return normalColor(frame.gbuffer.normal); }),
        png("depth.png", [&] { return depthPicture(frame.gbuffer.depthLinear); }),
        png("opacity.png", [&] { return falseColor(frame.opacity, 0.0f, 1.0f); }),
    };
    if (record.caches) files.push_back(png(kCachesPicture, [&] { return cachesPicture(*record.caches, stops); }));
    if (record.proxies)
        files.push_back(
            png(kProxiesPicture, [&] { return proxiesPicture(*record.proxies, record.camera, frame.combined.width, frame.combined.height, stops); }));
    std::vector<std::vector<std::byte>> encoded(files.size());
    parallelFor(encoded.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) encoded[i] = files[i].encode();
    });
    for (std::size_t i = 0; i < encoded.size(); ++i) folder.write(files[i].name, encoded[i]);
    folder.write("frame.json", jsonText(json));
}

}  // namespace lrsm
