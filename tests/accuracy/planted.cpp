#include "tests/accuracy/planted.h"

#include "conetrace/lrsm/gather.h"

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
    // No step is shorter than this, counted as the delay is in widths of the tap: a sphere's diameter is a tap's width or more.
    if (loss == Loss::transmittance) settings.cones.gather.emitterDelayTaps -= settings.cones.march.step;

    RenderOptions options{.width = width, .height = height, .watch = {.hashPasses = false, .progress = {}, .observe = {}}, .method = methodOf(settings)};
    options.method.gather = [&](const GatherInput& input, PassLog& log) {
        std::vector<Lrsm> lrsms = buildLrsms(input.rsms, settings.layers, log);
        if (loss == Loss::layer)
            for (Lrsm& lrsm : lrsms) dropLeastLayer(lrsm);
        Gathered gathered = traceCones(input.gbuffer, input.camera, input.opacity, lrsms, input.needs, settings.cones);
        gathered.filter4x4 = settings.cones.set.filter;
        return gathered;
    };
    Frame frame = renderFrame(scene, camera, settings, options);
    if (loss == Loss::albedo)
        for (std::size_t i = 0; i < frame.combined.texels.size(); ++i)
            frame.combined.texels[i] += (frame.gbuffer.albedo.texels[i] - 1.0f) * frame.indirectDiffuse.texels[i];
    return frame;
}

}  // namespace lrsm::accuracy
