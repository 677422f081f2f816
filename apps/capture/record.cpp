#include "apps/capture/record.h"

#include "apps/capture/fill.h"
#include "apps/capture/passes.h"
#include "apps/capture/scene_buffers.h"
#include "apps/capture/tables.h"
#include "apps/capture/tolerances.h"
#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/scene/exposure.h"
#include "core/scene/scene_hash.h"
#include "voxel/voxelize.h"

#include <algorithm>

namespace lrsm {

namespace {

void keepOnly(std::vector<Buffer>& buffers, const std::vector<std::string>& only)
{
    for (const std::string& asked : only)
        if (std::none_of(buffers.begin(), buffers.end(), [&](const Buffer& b) { return isAskedFor({asked}, b.pass); }))
            throw InputError("--only " + asked, "this frame has no such pass; they are " + passNames(" (of all lights; rsm0 of one)"));
    std::erase_if(buffers, [&](const Buffer& b) { return !isGiven(b.pass) && !isAskedFor(only, b.pass); });
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
    std::vector<Buffer> buffers =
        describeBuffers({.scene = scene, .needs = needs, .settings = settings, .width = options.width, .height = options.height, .layersStored = layersStored});
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
    capture.sceneReach = scene.reach;
    capture.origin = scene.origin;
    capture.grid = gridOf(scene, settings.voxel);
    capture.preExposure = preExposureOf(scene);
    capture.sceneComplete = withoutTextures(scene);
    capture.settings = settings;
    capture.needs = needs;
    capture.width = options.width;
    capture.height = options.height;
    capture.camera = camera;
    capture.materials = scene.materials;

    capture.lights.resize(scene.lights.size());
    for (std::size_t light = 0; light < scene.lights.size(); ++light) capture.lights[light].light = scene.lights[light];

    // How many layers an LRSM has is known when it is made: until then the buffers are described with all of them.
    const std::vector<int> layers(scene.lights.size(), settings.layers.depthLayers * settings.layers.normalLayers);
    capture.buffers = chosenBuffers(scene, needs, settings, options, layers);
    toBuffers(scene, capture.buffers);
    addTables(needs, settings, capture.buffers);

    RenderOptions render{.width = options.width, .height = options.height, .watch = {.progress = options.progress, .observe = {}}, .method = {}};
    render.watch.observe = [&](const std::string& pass, const PassOutput& output) {
        if (const PassRow* row = findPassRow(pass); row && row->record) row->record(output, lightOfPass(pass), capture);
    };
    const Frame frame = renderFrame(scene, camera, settings, render);
    if (options.finished) options.finished(frame);
    for (const PassRow& row : passRows())
        if (row.recordFrame) row.recordFrame(frame, capture);
    finish(capture.buffers);
    for (const PassReport& pass : frame.passes) capture.passes.push_back({pass.name, inputsOf(pass.name, settings, needs, scene.lights.size()), pass.sha256});
    return capture;
}

}  // namespace lrsm
