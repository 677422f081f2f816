#include "apps/check/rerun.h"

#include "apps/capture/convert.h"
#include "conetrace/frame/composite.h"
#include "conetrace/frame/direct.h"
#include "conetrace/frame/irradiance_filter.h"
#include "core/base/errors.h"
#include "voxel/pyramid_levels.h"
#include "voxel/voxelize.h"

#include <algorithm>
#include <cstdlib>

namespace lrsm {

namespace {

constexpr int kLevelsFromBits = 3;  // of directional pyramids (opacity_pyramid.h)

Scene wholeScene(const Capture& inputs)
{
    if (!inputs.sceneComplete) throw InputError("scene", "it has textures, which a capture does not hold");
    return sceneFromCapture(inputs);
}

std::vector<Rsm> rsmsOf(const Capture& inputs)
{
    std::vector<Rsm> rsms;
    for (std::size_t light = 0; light < inputs.lights.size(); ++light) rsms.push_back(rsmFromCapture(inputs, light));
    return rsms;
}

/// Each level from the level below as `inputs` has it.
void rerunVoxelMips(const Capture& inputs, std::vector<Buffer>& outputs)
{
    OpacityPyramid pyramid = opacityFromCapture(inputs);
    // From the top down, so that what a level is made from is still the captured one.
    const int fromBits = pyramid.axes == OpacityAxes::directional ? kLevelsFromBits : 1;
    for (int level = pyramid.levels() - 1; level > fromBits; --level) {
        const std::size_t channels = static_cast<std::size_t>(pyramid.channels()), n = static_cast<std::size_t>(pyramid.resolutionAt(level));
        const std::size_t first = pyramid.texelIndex(level, 0, 0, 0) * channels, count = n * n * n * channels;
        const auto clear = [&](auto& texels) {
            if (!texels.empty()) std::fill_n(texels.begin() + static_cast<std::ptrdiff_t>(first), count, 0);
        };
        clear(pyramid.unorm8);
        clear(pyramid.float32);
        fillLevelFromBelow(pyramid, level);
    }
    const OpacityPyramid fresh = buildPyramid(bitsFromCapture(inputs), inputs.settings.voxel);
    std::vector<Buffer> lower = outputs;
    toBuffers(pyramid, outputs);
    toBuffers(fresh, lower);
    for (std::size_t i = 0; i < outputs.size(); ++i)
        if (levelOf(outputs[i].name) <= fromBits) outputs[i].bytes = std::move(lower[i].bytes);
}

/// Base level from the RSM, each mip from the captured level below.
std::string rerunLrsm(const Capture& inputs, std::size_t light, std::vector<Buffer>& outputs)
{
    std::string why;
    const CapturedLight& captured = inputs.lights.at(light);
    std::vector<Buffer> base = outputs;
    try {
        const Rsm rsm = rsmFromCapture(inputs, light);
        std::vector<bool> keep;
        for (const int stored : captured.stored) keep.push_back(stored >= 0);
        toBuffers(buildLrsm(rsm, inputs.settings.layers, captured.partition, keep), light, base);
    } catch (const InputError& error) {
        why = error.what();
    }
    Lrsm lrsm = lrsmFromCapture(inputs, light);
    for (int level = lrsm.levels() - 1; level >= 1; --level) filterLevel(lrsm, level, inputs.settings.layers);
    toBuffers(lrsm, light, outputs);
    for (std::size_t i = 0; i < outputs.size(); ++i)
        if (levelOf(outputs[i].name) == 0) outputs[i].bytes = why.empty() ? std::move(base[i].bytes) : std::vector<std::byte>();
    return why;
}

void rerunCones(const Capture& inputs, std::vector<Buffer>& outputs)
{
    std::vector<Lrsm> lrsms;
    for (std::size_t light = 0; light < inputs.lights.size(); ++light) lrsms.push_back(lrsmFromCapture(inputs, light));
    ConeRecord record;
    const Gathered gathered =
        traceCones(gbufferFromCapture(inputs), inputs.camera, opacityFromCapture(inputs), lrsms, inputs.needs, inputs.settings.cones, &record);
    toBuffers(gathered, outputs);
    toBuffers(record, outputs);
}

void rerunDirect(const Capture& inputs, std::vector<Buffer>& outputs)
{
    const bool cones = inputs.settings.direct.shadows == Shadows::cone, maps = inputs.settings.direct.shadows == Shadows::hard;
    Scene lights = sceneFromCapture(inputs);
    const OpacityPyramid opacity = cones ? opacityFromCapture(inputs) : OpacityPyramid();
    std::vector<Rsm> rsms(inputs.lights.size());
    if (maps) rsms = rsmsOf(inputs);
    toBuffers(traceDirect(gbufferFromCapture(inputs), lights, inputs.camera, rsms, cones ? &opacity : nullptr, inputs.needs, inputs.settings.direct).radiance,
              "direct.radiance", outputs);
}

void rerunComposite(const Capture& inputs, std::vector<Buffer>& outputs)
{
    const GBuffer gbuffer = gbufferFromCapture(inputs);
    Image<Vec3> specular;
    if (inputs.needs.specular) specular = gatheredFromCapture(inputs).specular;
    IndirectLight indirect = shadeIndirect(gbuffer, inputs.camera, irradianceFromCapture(inputs), specular);
    toBuffers(indirect.diffuse, "composite.diffuse", outputs);
    toBuffers(indirect.specular, "composite.specular", outputs);
    // The sum of the candidate's own parts, so that a wrong part does not make the sum wrong.
    if (inputs.find("composite.diffuse")) indirect.diffuse = pictureFromCapture(inputs, "composite.diffuse");
    if (inputs.find("composite.specular")) indirect.specular = pictureFromCapture(inputs, "composite.specular");
    toBuffers(composite(pictureFromCapture(inputs, "direct.radiance"), indirect), "composite.combined", outputs);
}

std::string runAnew(const Capture& inputs, const std::string& pass, std::vector<Buffer>& outputs)
{
    const std::string kind = pass.substr(0, pass.find_last_of(' ') == std::string::npos || pass == "voxel mips" ? std::string::npos : pass.find_last_of(' '));
    const std::size_t light = lightOfPass(pass);
    if (kind == "voxelize") {
        OpacityPyramid bits;
        bits.base = voxelize(wholeScene(inputs), inputs.settings.voxel);
        toBuffers(bits, outputs);
    } else if (kind == "voxel mips") {
        rerunVoxelMips(inputs, outputs);
    } else if (kind == "rsm") {
        const Scene scene = wholeScene(inputs);
        toBuffers(renderRsm(scene, scene.lights.at(light), inputs.needs, inputs.settings.rsm), light, outputs);
    } else if (kind == "lrsm") {
        return rerunLrsm(inputs, light, outputs);
    } else if (kind == "gbuffer") {
        toBuffers(renderGBuffer(wholeScene(inputs), inputs.camera, inputs.needs, {inputs.width, inputs.height}), outputs);
    } else if (kind == "direct") {
        rerunDirect(inputs, outputs);
    } else if (kind == "cones") {
        rerunCones(inputs, outputs);
    } else if (kind == "filter") {
        toBuffers(filterIrradiance(pictureFromCapture(inputs, "cones.irradiance"), gbufferFromCapture(inputs)), "filter.irradiance", outputs);
    } else if (kind == "composite") {
        rerunComposite(inputs, outputs);
    } else {
        return "it is an input";
    }
    return {};
}

}  // namespace

std::size_t lightOfPass(const std::string& pass)
{
    const std::size_t space = pass.find_last_of(' ');
    return space == std::string::npos ? 0 : static_cast<std::size_t>(std::strtoul(pass.c_str() + space + 1, nullptr, 10));
}

int levelOf(const std::string& buffer)
{
    const std::size_t at = buffer.rfind("mip");
    return at == std::string::npos ? 0 : std::atoi(buffer.c_str() + at + 3);
}

bool readsSceneAlone(const CapturedPass& pass)
{
    return std::all_of(pass.inputs.begin(), pass.inputs.end(), [](const std::string& input) { return input == "scene" || input == "tables"; });
}

std::optional<Buffer> wideOutput(const Capture& inputs, const std::string& name)
{
    const Buffer* described = inputs.find(name);
    if (!described || described->encoding == Encoding::bits) return {};
    std::vector<Buffer> outputs = {*described};
    outputs[0].dtype = Dtype::f4;
    outputs[0].encoding = Encoding::number;
    outputs[0].bytes.clear();
    Settings settings = inputs.settings;
    settings.rsm.storage = settings.layers.storage = Storage::float32;
    const std::size_t light = lightOfPass(described->pass);
    try {
        if (described->pass.starts_with("lrsm") && levelOf(name) == 0) {
            std::vector<bool> keep;
            for (const int stored : inputs.lights.at(light).stored) keep.push_back(stored >= 0);
            toBuffers(buildLrsm(rsmFromCapture(inputs, light), settings.layers, inputs.lights[light].partition, keep), light, outputs);
        } else if (described->pass.starts_with("rsm")) {
            const Scene scene = wholeScene(inputs);
            toBuffers(renderRsm(scene, scene.lights.at(light), inputs.needs, settings.rsm), light, outputs);
        }
    } catch (const InputError&) {
        return {};
    }
    if (outputs[0].bytes.empty()) return {};
    return std::move(outputs[0]);
}

Rerun rerunPass(const Capture& inputs, const std::string& pass)
{
    Rerun rerun;
    for (const Buffer& buffer : inputs.buffers) {
        if (buffer.pass != pass) continue;
        rerun.outputs.push_back(buffer);
        rerun.outputs.back().bytes.clear();
    }
    try {
        rerun.why = runAnew(inputs, pass, rerun.outputs);
    } catch (const InputError& error) {
        rerun.why = error.what();
        rerun.outputs.clear();
    }
    std::erase_if(rerun.outputs, [](const Buffer& buffer) { return buffer.bytes.empty() && buffer.elements() > 0; });
    return rerun;
}

}  // namespace lrsm
