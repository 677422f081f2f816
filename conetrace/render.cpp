#include "conetrace/render.h"

#include "conetrace/frame/composite.h"
#include "conetrace/frame/direct.h"
#include "conetrace/frame/irradiance_filter.h"
#include "conetrace/pass_log.h"
#include "core/base/float_state.h"
#include "core/scene/check_scene.h"
#include "core/settings/settings_table.h"
#include "voxel/voxelize.h"

namespace lrsm {
namespace {

Frame::LightReport reportLight(const Rsm& rsm, const Lrsm& lrsm)
{
    Frame::LightReport report;
    report.raster = rsm.raster;
    report.conversions = rsm.conversions;
    report.conversions += lrsm.conversions;
    report.ranges = lrsm.ranges;
    report.validTexelsPerLayer = lrsm.validTexelsPerLayer;
    report.layersAsked = lrsm.layersAsked;
    report.negativeVariances = lrsm.negativeVariances;
    return report;
}

constexpr int kPassesPerFrame = 8, kPassesPerLight = 2;

}  // namespace

Frame renderFrame(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, const RenderOptions& options)
{
    const FloatState state;
    checkScene(scene);
    validate(settings);
    Frame frame;
    const FrameObserver nobody;
    const FrameObserver& observer = options.observer ? *options.observer : nobody;
    PassLog log(options, kPassesPerFrame + kPassesPerLight * static_cast<int>(scene.lights.size()));

    // Occlusion: binary voxels and their mips.
    BitGrid occupied = log.run("voxelize", [&] { return voxelize(scene, settings.voxel); });
    frame.voxelsSet = occupied.countOccupied();
    const OpacityPyramid opacity = log.run("voxel mips", [&] { return buildPyramid(std::move(occupied), settings.voxel); });
    if (observer.opacity) observer.opacity(opacity);

    // Light: an RSM a light, split into pre-filtered layers.
    std::vector<Rsm> rsms;
    std::vector<Lrsm> lrsms;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const std::string number = " " + std::to_string(i);
        rsms.push_back(log.run("rsm" + number, [&] { return renderRsm(scene, scene.lights[i], needs, settings.rsm); }));
        lrsms.push_back(log.run("lrsm" + number, [&] { return buildLrsm(rsms.back(), settings.layers); }));
        frame.lights.push_back(reportLight(rsms.back(), lrsms.back()));
        if (observer.rsm) observer.rsm(i, rsms.back());
        if (observer.lrsm) observer.lrsm(i, lrsms.back());
    }

    // Eye: the visible surfaces, their direct light, and the cones.
    frame.gbuffer = log.run("gbuffer", [&] { return renderGBuffer(scene, camera, needs, {options.width, options.height}); });
    frame.direct = log.run("direct", [&] { return traceDirect(frame.gbuffer, scene, camera, rsms, &opacity, needs, settings.direct).radiance; });
    ConeRecord record;
    Gathered gathered =
        log.run("cones", [&] { return traceCones(frame.gbuffer, camera, opacity, lrsms, needs, settings.cones, observer.cones ? &record : nullptr); });
    if (observer.cones) observer.cones(gathered, record);
    if (options.replaceDiffuse)
        gathered = log.run("rays", [&] {
            options.replaceDiffuse(frame.gbuffer, opacity, lrsms, gathered);
            return std::move(gathered);
        });
    else if (settings.cones.filter)
        gathered.irradiance = log.run("filter", [&] { return filterIrradiance(gathered.irradiance, frame.gbuffer); });

    // Picture.
    frame.combined = log.run("composite", [&] {
        IndirectLight indirect = shadeIndirect(frame.gbuffer, camera, gathered.irradiance, gathered.specular);
        Image<Vec3> sum = composite(frame.direct, indirect);
        frame.indirectDiffuse = std::move(indirect.diffuse);
        frame.indirectSpecular = std::move(indirect.specular);
        return sum;
    });
    frame.irradiance = std::move(gathered.irradiance);
    frame.opacity = std::move(gathered.opacity);
    frame.cones = gathered.counts;
    frame.gbufferRaster = frame.gbuffer.raster;
    frame.passes = std::move(log.reports);
    return frame;
}

std::string explainPixel(const Scene& scene, const Camera& camera, const Requirements& needs, const Settings& settings, const RenderOptions& options, int x,
                         int y)
{
    const FloatState state;
    checkScene(scene);
    validate(settings);
    const OpacityPyramid opacity = buildPyramid(voxelize(scene, settings.voxel), settings.voxel);
    std::vector<Lrsm> lrsms;
    for (const Light& light : scene.lights) lrsms.push_back(buildLrsm(renderRsm(scene, light, needs, settings.rsm), settings.layers));
    const GBuffer gbuffer = renderGBuffer(scene, camera, needs, {options.width, options.height});
    return explainCones(gbuffer, camera, opacity, lrsms, needs, settings.cones, x, y);
}

}  // namespace lrsm
