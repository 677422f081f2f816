#include "apps/capture/record.h"

#include "apps/capture/convert.h"
#include "apps/capture/fill.h"
#include "apps/capture/scene_buffers.h"
#include "apps/capture/tables.h"
#include "apps/capture/tolerances.h"
#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/scene/scene_hash.h"

#include <algorithm>

namespace lrsm {

namespace {

/// "lrsm 0" and "lrsm0" are one pass, "lrsm" means it for every light; "voxel-mips" is "voxel mips".
std::string plain(const std::string& pass)
{
    std::string letters;
    for (const char letter : pass)
        if (letter != ' ' && letter != '-' && letter != '_') letters += letter;
    return letters;
}

bool means(const std::string& asked, const std::string& pass)
{
    const std::string a = plain(asked), b = plain(pass);
    return a == b || (b.starts_with(a) && b.size() > a.size() && (a == "rsm" || a == "lrsm"));
}

bool given(const std::string& pass)
{
    return pass == "scene" || pass == "tables";
}

void keepOnly(std::vector<Buffer>& buffers, const std::vector<std::string>& only)
{
    if (only.empty()) return;
    for (const std::string& asked : only)
        if (std::none_of(buffers.begin(), buffers.end(), [&](const Buffer& b) { return means(asked, b.pass); }))
            throw InputError("--only " + asked,
                             "this frame has no such pass; they are voxelize, voxel-mips, rsm, lrsm (of all lights; rsm0 of one), "
                             "gbuffer, direct, cones, filter, composite");
    std::erase_if(buffers, [&](const Buffer& b) {
        return !given(b.pass) && std::none_of(only.begin(), only.end(), [&](const std::string& asked) { return means(asked, b.pass); });
    });
}

/// What each pass reads, as renderFrame has it.
std::vector<std::string> inputsOf(const std::string& pass, std::size_t lights, const Settings& settings)
{
    const auto withLights = [&](std::vector<std::string> names, const std::string& prefix) {
        for (std::size_t i = 0; i < lights; ++i) names.push_back(prefix + std::to_string(i));
        return names;
    };
    if (pass == "voxelize" || pass == "gbuffer" || pass.starts_with("rsm ")) return {"scene"};
    if (pass == "voxel mips") return {"voxelize"};
    if (pass.starts_with("lrsm ")) return {pass.substr(1)};
    if (pass == "direct") {
        if (settings.direct.shadows == Shadows::hard) return withLights({"gbuffer"}, "rsm ");
        if (settings.direct.shadows == Shadows::cone) return {"gbuffer", "voxelize", "voxel mips"};
        return {"gbuffer"};
    }
    if (pass == "cones") return withLights({"tables", "gbuffer", "voxelize", "voxel mips"}, "lrsm ");
    if (pass == "filter") return {"gbuffer", "cones"};
    std::vector<std::string> composite = {"tables", "gbuffer", "direct", "cones"};
    if (settings.cones.set.filter) composite.push_back("filter");
    return composite;
}

/// Which of the partition's layers the LRSM holds: they come in the same order.
CapturedLight capturedLight(const Light& light, const LightProjection& projection, const std::vector<LayerRange>& partition, const Lrsm& lrsm)
{
    CapturedLight captured{light, projection, partition, {}, lrsm.validTexelsPerLayer};
    int next = 0;
    for (const LayerRange& range : captured.partition) {
        const bool stored = next < lrsm.layers() && lrsm.ranges[static_cast<std::size_t>(next)] == range;
        captured.stored.push_back(stored ? next++ : -1);
    }
    return captured;
}

void addTables(const Requirements& needs, const Settings& settings, std::vector<Buffer>& buffers)
{
    const CaptureTables tables = makeTables(needs, settings);
    for (const Table* table : tables.all())
        if (!table->shape.empty()) copyTo(buffers, table->name, table->bytes);
}

/// Hashes, and what depends on the values themselves.
void finish(std::vector<Buffer>& buffers)
{
    parallelFor(buffers.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            buffers[i].sha256 = Sha256().add(buffers[i].bytes).hex();
            tolerances::setFloor(buffers[i]);
        }
    });
}

}  // namespace

std::vector<Buffer> chosenBuffers(const Scene& scene, const Requirements& needs, const Settings& settings, const RecordOptions& options,
                                  const std::vector<int>& layersStored)
{
    std::vector<Buffer> buffers = describeBuffers(scene, needs, settings, options.width, options.height, layersStored);
    keepOnly(buffers, options.only);
    if (!options.dds)
        for (Buffer& buffer : buffers) buffer.dds.reset();
    return buffers;
}

Capture recordCapture(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, const RecordOptions& options,
                      const std::string& version)
{
    Capture capture;
    capture.version = version;
    capture.sceneName = scene.name;
    capture.sceneHash = hashScene(scene);
    capture.sceneBounds = scene.bounds;
    capture.sceneComplete = withoutTextures(scene);
    capture.settings = settings;
    capture.needs = needs;
    capture.width = options.width;
    capture.height = options.height;
    capture.camera = camera;
    capture.materials = scene.materials;

    // How many layers an LRSM has is known when it is made: until then the buffers are described with all of them.
    std::vector<int> layers(scene.lights.size(), settings.layers.depthLayers * settings.layers.normalLayers);
    std::vector<Buffer>& buffers = capture.buffers;
    buffers = chosenBuffers(scene, needs, settings, options, layers);
    toBuffers(scene, buffers);
    addTables(needs, settings, buffers);

    std::vector<LightProjection> projections;
    std::vector<std::vector<LayerRange>> partitions;
    const auto keepLrsm = [&](const std::string& pass, const Lrsm& lrsm) {
        const std::size_t light = capture.lights.size();
        capture.lights.push_back(capturedLight(scene.lights[light], projections[light], partitions[light], lrsm));
        if (lrsm.layers() == 0) std::erase_if(buffers, [&](const Buffer& b) { return b.pass == pass; });
        for (Buffer& buffer : buffers)
            if (buffer.pass == pass) buffer.shape[0] = static_cast<std::size_t>(lrsm.layers());
        toBuffers(lrsm, light, buffers);
    };

    RenderOptions render{.width = options.width, .height = options.height, .watch = {.progress = options.progress, .observe = {}}, .method = {}};
    render.watch.observe = [&](const std::string& pass, const PassOutput& output) {
        if (const auto* opacity = output.as<OpacityPyramid>()) {
            capture.grid = opacity->base.grid;
            toBuffers(*opacity, buffers);
        } else if (const auto* rsm = output.as<Rsm>()) {
            toBuffers(*rsm, projections.size(), buffers);
            projections.push_back(rsm->projection);
            partitions.push_back(partition(*rsm, settings.layers));
        } else if (const auto* lrsm = output.as<Lrsm>()) {
            keepLrsm(pass, *lrsm);
        } else if (const auto* gathered = output.as<Gathered>()) {
            toBuffers(*gathered, buffers);
        } else if (const auto* cones = output.as<ConeRecord>()) {
            toBuffers(*cones, buffers);
        }
    };
    const Frame frame = renderFrame(scene, camera, settings, render);
    toBuffers(frame.gbuffer, buffers);
    toBuffers(frame.direct, "direct.radiance", buffers);
    if (settings.cones.set.filter) toBuffers(frame.irradiance, "filter.irradiance", buffers);
    toBuffers(frame.indirectDiffuse, "composite.diffuse", buffers);
    toBuffers(frame.indirectSpecular, "composite.specular", buffers);
    toBuffers(frame.combined, "composite.combined", buffers);
    finish(buffers);
    for (const PassReport& pass : frame.passes) capture.passes.push_back({pass.name, inputsOf(pass.name, scene.lights.size(), settings), pass.sha256});
    return capture;
}

}  // namespace lrsm
