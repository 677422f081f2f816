#include "tests/accuracy/planted.h"

#include "conetrace/frame/composite.h"
#include "conetrace/frame/direct.h"
#include "conetrace/frame/irradiance_filter.h"
#include "core/base/float_state.h"
#include "voxel/voxelize.h"

#include <algorithm>

namespace lrsm::accuracy {
namespace {

void dropLeastLayer(Lrsm& lrsm)
{
    const auto& valid = lrsm.validTexelsPerLayer;
    const auto layer = std::min_element(valid.begin(), valid.end()) - valid.begin();
    const auto begin = lrsm.texels.begin() + layer * static_cast<std::ptrdiff_t>(lrsm.texelsPerLayer);
    std::fill_n(begin, lrsm.texelsPerLayer, LrsmTexel{});
}

}  // namespace

Frame renderWithLoss(const Scene& scene, const Camera& camera, Settings settings, int width, int height, Loss loss)
{
    const FloatState state;
    const Requirements needs = analyseRequirements(scene, settings.force);
    // No step is shorter than this, counted as the delay is in widths of the tap: a sphere's diameter is a tap's width or more.
    if (loss == Loss::transmittance) settings.cones.emitterDelayTaps -= settings.cones.step;

    const OpacityPyramid opacity = buildPyramid(voxelize(scene, settings.voxel), settings.voxel);
    std::vector<Rsm> rsms;
    std::vector<Lrsm> lrsms;
    for (const Light& light : scene.lights) {
        rsms.push_back(renderRsm(scene, light, needs, settings.rsm));
        lrsms.push_back(buildLrsm(rsms.back(), settings.layers));
        if (loss == Loss::layer) dropLeastLayer(lrsms.back());
    }

    Frame frame;
    frame.gbuffer = renderGBuffer(scene, camera, needs, {width, height});
    frame.direct = traceDirect(frame.gbuffer, scene, camera, rsms, &opacity, needs, settings.direct).radiance;
    const Gathered gathered = traceCones(frame.gbuffer, camera, opacity, lrsms, needs, settings.cones);
    frame.irradiance = settings.cones.filter ? filterIrradiance(gathered.irradiance, frame.gbuffer) : gathered.irradiance;
    IndirectLight indirect = shadeIndirect(frame.gbuffer, camera, frame.irradiance, gathered.specular);
    if (loss == Loss::albedo)
        for (std::size_t i = 0; i < indirect.diffuse.texels.size(); ++i) indirect.diffuse.texels[i] *= frame.gbuffer.albedo.texels[i];
    frame.combined = composite(frame.direct, indirect);
    frame.indirectSpecular = std::move(indirect.specular);
    return frame;
}

}  // namespace lrsm::accuracy
