#include "conetrace/render.h"

#include "conetrace/caches/gather.h"
#include "conetrace/frame/composite.h"
#include "conetrace/frame/direct.h"
#include "conetrace/frame/irradiance_filter.h"
#include "conetrace/frame/reduce.h"
#include "conetrace/frame/smooth_irradiance.h"
#include "conetrace/frame/world.h"
#include "conetrace/ism/gather.h"
#include "conetrace/lrsm/gather.h"
#include "conetrace/proxies/gather.h"
#include "conetrace/vct/gather.h"
#include "core/base/errors.h"
#include "core/base/float_state.h"
#include "core/scene/check_scene.h"
#include "core/settings/settings_table.h"

namespace lrsm {
namespace {

GBufferSettings gbufferSettings(const Settings& settings, const RenderOptions& options)
{
    return {options.width, options.height, settings.surface.textureFilter};
}

/// Light at each pixel by the chosen method; in the first `rows` averaged over the cone rotations of a 4x4 pattern, where it has one.
Gathered gatherPixels(const GatherMethod& method, const GatherInput& input, int rows, PassLog& log)
{
    Gathered light = method.gather(input, log);
    if (!light.filter4x4) return light;
    light.irradiance = log.run("filter", kPicturePass, [&] { return filterIrradiance(light.irradiance, input.gbuffer, rows); });
    if (!light.lobeWeight.empty())
        light.specular = log.run("specular filter", kPicturePass, [&] { return filterSpecular(light.specular, light.lobeWeight, input.gbuffer, rows); });
    return light;
}

/// The same by way of one pixel a block.
Gathered gatherBlocks(const GatherMethod& method, const GatherInput& input, PassLog& log)
{
    const ReducedGBuffer reduced = log.run("reduce", kPicturePass, [&] { return reduceGBuffer(input.gbuffer, input.settings.cones.set.gatherDivisor); });
    const GatherInput few{.scene = input.scene,
                          .camera = input.camera,
                          .needs = input.needs,
                          .settings = input.settings,
                          .gbuffer = reduced.gbuffer,
                          .rsms = input.rsms,
                          .opacity = input.opacity,
                          .lanes = input.lanes,
                          .kept = input.kept};
    const Gathered light = gatherPixels(method, few, reduced.blockRows, log);
    return log.run("upsample", kPicturePass, [&] { return upsample(light, reduced, input.gbuffer); });
}

/// From gathered light to the picture.
void finish(Frame& frame, const Camera& camera, const Settings& settings, Gathered light, PassLog& log)
{
    frame.irradiance = std::move(light.irradiance);
    if (const int passes = settings.cones.set.filterPasses; light.filter4x4 && passes > 0)
        frame.irradiance = log.run("smooth", kPicturePass, [&] { return smoothIrradiance(frame.irradiance, frame.gbuffer, passes); });
    frame.combined = log.run("composite", kPicturePass, [&] {
        IndirectLight indirect = shadeIndirect(frame.gbuffer, camera, frame.irradiance, light.specular);
        Image<Vec3> sum = composite(frame.direct, indirect);
        frame.indirectDiffuse = std::move(indirect.diffuse);
        frame.indirectSpecular = std::move(indirect.specular);
        return sum;
    });
    frame.opacity = std::move(light.opacity);
    frame.passes = std::move(log.reports);
}

GatherMethod chosenMethod(const Settings& settings, const RenderOptions& options)
{
    return options.method.gather ? options.method : methodOf(settings);
}

/// For the progress bar: G-buffer, direct, filter, composite; voxels and their mips a cascade; the method's are counted by what it predicts, and its gather.
std::size_t expectedPasses(const Scene& scene, int cascades)
{
    constexpr std::size_t kOfTheFrame = 4, kGather = 1, kPerLight = 2, kPerCascade = 2;
    return kOfTheFrame + kGather + kPerLight * scene.lights.size() + kPerCascade * std::size_t(cascades);
}

}  // namespace

GatherMethod methodOf(const Settings& settings)
{
    switch (settings.method) {
    case Method::lrsm: return lrsmMethod(settings.cones.march.visibility);
    case Method::vct: return vctMethod();
    case Method::caches: return cachesMethod(settings.caches);
    case Method::proxies: return proxiesMethod();
    case Method::ism: return ismMethod();
    }
    throw InputError("method", "is none of the known");
}

Requirements prepare(const Scene& scene, const Settings& settings)
{
    checkScene(scene);
    validate(settings);
    return analyseRequirements(scene, settings.force);
}

Frame renderFrame(const Scene& scene, const Camera& camera, const Settings& settings, const RenderOptions& options)
{
    const FloatState state;
    Frame frame;
    frame.needs = prepare(scene, settings);
    const Requirements& needs = frame.needs;
    const GatherMethod method = chosenMethod(settings, options);
    PassLog log(options.watch, expectedPasses(scene, settings.voxel.cascades));

    // What is there: occlusion as voxels, light as a reflective shadow map a light.
    World ownWorld;
    World& world = options.kept ? *options.kept : ownWorld;
    buildWorld(world, options.kept != nullptr, scene, camera, needs, settings, method.reads, log);

    // What the eye sees, and its direct light.
    frame.gbuffer = log.run("gbuffer", kSurfacePass, [&] { return renderGBuffer(scene, camera, needs, gbufferSettings(settings, options)); });
    frame.direct = log.run("direct", kPicturePass,
                           [&] { return traceDirect(frame.gbuffer, scene, camera, world.depths(), &world.opacity, needs, settings.direct).radiance; });

    // Indirect light, by the chosen method, and the picture.
    const GatherInput input{.scene = scene,
                            .camera = camera,
                            .needs = needs,
                            .settings = settings,
                            .gbuffer = frame.gbuffer,
                            .rsms = world.rsms,
                            .opacity = world.opacity,
                            .lanes = options.lanes,
                            .kept = options.kept};
    Gathered light = settings.cones.set.gatherDivisor == 1 || !method.pixelByPixel ? gatherPixels(method, input, frame.gbuffer.height, log)
                                                                                   : gatherBlocks(method, input, log);
    finish(frame, camera, settings, std::move(light), log);
    return frame;
}

std::string explainPixel(const Scene& scene, const Camera& camera, const Settings& settings, const RenderOptions& options, int x, int y)
{
    const FloatState state;
    const Requirements needs = prepare(scene, settings);
    const GatherMethod method = chosenMethod(settings, options);
    if (!method.explain) throw InputError("--pixel", "this method explains no pixel");
    const PassWatch nobody{.hashPasses = false, .progress = {}, .observe = {}};
    PassLog log(nobody);
    World world;
    buildWorld(world, false, scene, camera, needs, settings, method.reads, log);
    const GBuffer gbuffer = renderGBuffer(scene, camera, needs, gbufferSettings(settings, options));
    return method.explain(
        {.scene = scene, .camera = camera, .needs = needs, .settings = settings, .gbuffer = gbuffer, .rsms = world.rsms, .opacity = world.opacity}, x, y);
}

std::vector<MemoryRow> predictMemory(const MemoryQuestion& question)
{
    const Settings& settings = question.settings;
    const GatherMethod method = methodOf(settings);
    std::vector<MemoryRow> rows = predictVoxels(settings.voxel, method.reads.bits, method.reads.mips || settings.direct.shadows == Shadows::cone);
    const std::vector<MemoryRow> maps = predictRsms(settings.rsm, question.scene.lights.size());
    rows.insert(rows.end(), maps.begin(), maps.end());
    const std::vector<MemoryRow> shadows = predictShadowMaps(settings, question.scene.lights.size());
    rows.insert(rows.end(), shadows.begin(), shadows.end());
    if (method.predict) {
        const std::vector<MemoryRow> own = method.predict(question);
        rows.insert(rows.end(), own.begin(), own.end());
    }
    rows.push_back(predictGBuffer(question));
    return rows;
}

}  // namespace lrsm
