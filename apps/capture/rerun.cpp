#include "apps/capture/rerun.h"

#include "apps/capture/map_buffers.h"
#include "apps/capture/passes.h"
#include "apps/capture/picture_buffers.h"
#include "apps/capture/scene_buffers.h"
#include "apps/capture/voxel_buffers.h"
#include "conetrace/frame/composite.h"
#include "conetrace/frame/direct.h"
#include "conetrace/frame/irradiance_filter.h"
#include "conetrace/frame/smooth_irradiance.h"
#include "core/base/errors.h"
#include "voxel/pyramid_levels.h"
#include "voxel/voxelize.h"

#include <algorithm>

namespace lrsm {

namespace {

constexpr int kLevelsFromBits = 3;  // of directional pyramids (opacity_pyramid.h)

/// The pass's buffers as `inputs` describes them, without bytes.
std::vector<Buffer> emptyOutputs(const Capture& inputs, const std::string& pass)
{
    std::vector<Buffer> outputs;
    for (const Buffer& buffer : inputs.buffers) {
        if (buffer.pass != pass) continue;
        outputs.push_back(buffer);
        outputs.back().bytes.clear();
    }
    return outputs;
}

}  // namespace

Scene wholeScene(const Capture& inputs)
{
    if (!inputs.sceneComplete) throw InputError("scene", "it has textures, which a capture does not hold");
    return sceneFromCapture(inputs);
}

Rerun rerunPass(const Capture& inputs, const std::string& pass)
{
    const PassRow* row = findPassRow(pass);
    Rerun made{emptyOutputs(inputs, pass), {}};
    try {
        if (row && row->rerun)
            row->rerun(inputs, lightOfPass(pass), made);
        else if (row && row->makeMap)
            row->makeMap(inputs, inputs.settings, lightOfPass(pass), made.outputs);
        else
            made.why = "it is an input";
    } catch (const InputError& error) {
        made.why = error.what();
        made.outputs.clear();
    }
    std::erase_if(made.outputs, [](const Buffer& buffer) { return buffer.bytes.empty() && buffer.elements() > 0; });
    return made;
}

std::optional<Buffer> wideOutput(const Capture& inputs, const std::string& name)
{
    const Buffer* described = inputs.find(name);
    const PassRow* row = described ? findPassRow(described->pass) : nullptr;
    if (!row || !row->makeMap || levelOf(name) > 0) return {};
    std::vector<Buffer> outputs = {*described};
    outputs[0].dtype = Dtype::f4;
    outputs[0].encoding = Encoding::number;
    outputs[0].bytes.clear();
    Settings settings = inputs.settings;
    settings.rsm.storage = settings.layers.storage = settings.vct.storage = settings.caches.storage = Storage::float32;
    try {
        row->makeMap(inputs, settings, lightOfPass(described->pass), outputs);
    } catch (const InputError&) {
        return {};
    }
    if (outputs[0].bytes.empty()) return {};
    return std::move(outputs[0]);
}

void rerunVoxelize(const Capture& inputs, std::size_t, Rerun& made)
{
    toBuffers(voxelize(wholeScene(inputs), inputs.settings.voxel), made.outputs);
}

/// Each level from the level below as `inputs` has it.
void rerunVoxelMips(const Capture& inputs, std::size_t, Rerun& made)
{
    OpacityPyramid pyramid = opacityFromCapture(inputs);
    // From the top down, so that what a level is made from is still the captured one.
    const int fromBits = pyramid.axes == OpacityAxes::directional ? kLevelsFromBits : 1;
    for (int level = pyramid.levels() - 1; level > fromBits; --level) {
        const auto channels = static_cast<std::size_t>(pyramid.channels()), n = static_cast<std::size_t>(pyramid.resolutionAt(level));
        const std::size_t first = pyramid.texelIndex(level, 0, 0, 0) * channels, count = n * n * n * channels;
        const auto clear = [&](auto& texels) {
            if (!texels.empty()) std::fill_n(texels.begin() + static_cast<std::ptrdiff_t>(first), count, 0);
        };
        clear(pyramid.unorm8);
        clear(pyramid.float32);
        fillLevelFromBelow(pyramid, level);
    }
    const OpacityPyramid fresh = buildPyramid(bitsFromCapture(inputs), inputs.settings.voxel);
    std::vector<Buffer>& outputs = made.outputs;
    std::vector<Buffer> lower = outputs;
    toBuffers(pyramid, outputs);
    toBuffers(fresh, lower);
    for (std::size_t i = 0; i < outputs.size(); ++i)
        if (levelOf(outputs[i].name) <= fromBits) outputs[i].bytes = std::move(lower[i].bytes);
}

void makeRsm(const Capture& inputs, const Settings& settings, std::size_t light, std::vector<Buffer>& outputs)
{
    const Scene scene = wholeScene(inputs);
    toBuffers(renderRsm(scene, scene.lights.at(light), inputs.needs, settings.rsm, settings.surface.textureFilter), light, outputs);
}

void makeLrsmBase(const Capture& inputs, const Settings& settings, std::size_t light, std::vector<Buffer>& outputs)
{
    const CapturedLight& captured = inputs.lights.at(light);
    std::vector<bool> stored;
    for (const int layer : captured.stored) stored.push_back(layer >= 0);
    toBuffers(buildLrsm(rsmFromCapture(inputs, light), settings.layers, captured.partition, stored), light, outputs);
}

void rerunShadow(const Capture& inputs, std::size_t light, Rerun& made)
{
    const Scene scene = wholeScene(inputs);
    const LightProjection projection = refine(inputs.lights.at(light).projection, inputs.settings.direct.shadowResolution);
    toBuffers(renderDepthMap(scene, scene.lights.at(light), inputs.needs, projection), light, made.outputs);
}

/// Base level from the RSM, each mip from the captured level below.
void rerunLrsm(const Capture& inputs, std::size_t light, Rerun& made)
{
    std::vector<Buffer> base = made.outputs;
    try {
        makeLrsmBase(inputs, inputs.settings, light, base);
    } catch (const InputError& error) {
        made.why = error.what();
    }
    Lrsm lrsm = lrsmFromCapture(inputs, light);
    for (int level = lrsm.levels() - 1; level >= 1; --level) filterLevel(lrsm, level, inputs.settings.layers);
    toBuffers(lrsm, light, made.outputs);
    for (std::size_t i = 0; i < base.size(); ++i)
        if (levelOf(base[i].name) == 0) made.outputs[i].bytes = made.why.empty() ? std::move(base[i].bytes) : std::vector<std::byte>();
}

void rerunGBuffer(const Capture& inputs, std::size_t, Rerun& made)
{
    toBuffers(renderGBuffer(wholeScene(inputs), inputs.camera, inputs.needs, {inputs.width, inputs.height}), made.outputs);
}

void rerunDirect(const Capture& inputs, std::size_t, Rerun& made)
{
    const DirectSettings& settings = inputs.settings.direct;
    const Scene scene = settings.shadows == Shadows::exact ? wholeScene(inputs) : sceneFromCapture(inputs);
    const OpacityPyramid opacity = settings.shadows == Shadows::cone ? opacityFromCapture(inputs) : OpacityPyramid();
    const std::vector<DepthMap> maps = readsDepthMaps(settings) ? mapsOf(inputs, depthMapFromCapture) : std::vector<DepthMap>();
    const std::vector<DepthMapView> depths(maps.begin(), maps.end());
    toBuffers(traceDirect(gbufferFromCapture(inputs), scene, inputs.camera, depths, &opacity, inputs.needs, settings).radiance, "direct.radiance",
              made.outputs);
}

void rerunCones(const Capture& inputs, std::size_t, Rerun& made)
{
    ConeRecord record;
    toBuffers(traceCones(gbufferFromCapture(inputs), inputs.camera, opacityFromCapture(inputs), mapsOf(inputs, lrsmFromCapture), inputs.needs,
                         inputs.settings.cones, &record),
              made.outputs);
    toBuffers(record, made.outputs);
}

void rerunFilter(const Capture& inputs, std::size_t, Rerun& made)
{
    toBuffers(filterIrradiance(pictureFromCapture(inputs, "cones.irradiance"), gbufferFromCapture(inputs)), "filter.irradiance", made.outputs);
}

void rerunSpecularFilter(const Capture& inputs, std::size_t, Rerun& made)
{
    const Gathered gathered = gatheredFromCapture(inputs);
    toBuffers(filterSpecular(gathered.specular, gathered.lobeWeight, gbufferFromCapture(inputs), inputs.height), "filter.specular", made.outputs);
}

void rerunSmooth(const Capture& inputs, std::size_t, Rerun& made)
{
    toBuffers(smoothIrradiance(filteredFromCapture(inputs), gbufferFromCapture(inputs), inputs.settings.cones.set.smoothingPasses()), "smooth.irradiance",
              made.outputs);
}

void rerunComposite(const Capture& inputs, std::size_t, Rerun& made)
{
    IndirectLight indirect = shadeIndirect(gbufferFromCapture(inputs), inputs.camera, irradianceFromCapture(inputs), specularFromCapture(inputs));
    toBuffers(indirect.diffuse, "composite.diffuse", made.outputs);
    toBuffers(indirect.specular, "composite.specular", made.outputs);
    // The sum of the candidate's own parts, so that a wrong part does not make the sum wrong.
    if (inputs.find("composite.diffuse")) indirect.diffuse = pictureFromCapture(inputs, "composite.diffuse");
    if (inputs.find("composite.specular")) indirect.specular = pictureFromCapture(inputs, "composite.specular");
    toBuffers(composite(pictureFromCapture(inputs, "direct.radiance"), indirect), "composite.combined", made.outputs);
}

}  // namespace lrsm
