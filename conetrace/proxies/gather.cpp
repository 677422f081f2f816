#include "conetrace/proxies/gather.h"

#include "conetrace/proxies/explain.h"
#include "conetrace/proxies/memory.h"

#include <optional>

namespace lrsm {
ProxyCells buildProxyCells(const GatherInput& input, PassLog& log)
{
    const Settings& settings = input.settings;
    const PointProxies proxies = log.run("pp place", kPassedOn, [&] { return placeProxies(input.scene, settings.proxies, settings.surface.textureFilter); });
    const ProxyLight light = log.run("pp light", kPassedOn, [&] { return lightProxies(input, proxies); });
    return log.run("pp cells", kWorldPass, [&] { return sortProxies(input.scene, proxies, light, settings.proxies); });
}

ProxyVisibility seeCells(const GatherInput& input, const ProxyCells& cells, PassLog& log)
{
    const ProxySettings& settings = input.settings.proxies;
    const ConeSet rays = shadowRays(settings);
    const MarchWorld world{
        .gbuffer = input.gbuffer, .camera = input.camera, .cells = cells, .rays = rays, .settings = settings, .specular = input.needs.specular};
    ProxyVisibility seen;
    seen.marched = log.run("pp march", kSurfacePass, [&] { return marchShadowRays(world); });
    if (settings.filterRadius > 0)
        seen.filtered = log.run("pp filter", kSurfacePass, [&] { return filterVisibility(seen.marched, input.gbuffer, cells, settings); });
    if (settings.cellWeight == ProxyCellWeight::seen)
        seen.seen = log.run("pp weigh", kSurfacePass, [&] { return weighProxies(cells, seen.marched.proxyHits); });
    return seen;
}

Gathered gatherProxies(const GatherInput& input, PassLog& log)
{
    const ProxySettings& settings = input.settings.proxies;
    const ProxyCells cells = buildProxyCells(input, log);
    const ProxyVisibility seen = seeCells(input, cells, log);
    std::optional<VplLobeIntegral> lobe;
    if (input.needs.specular && settings.lobeNorm == ProxyLobeNorm::lobe) lobe.emplace(input.settings.vpl);
    const GatherWorld world{.gbuffer = input.gbuffer,
                            .camera = input.camera,
                            .cells = cells,
                            .lists = seen.lists(),
                            .settings = settings,
                            .vpl = input.settings.vpl,
                            .lobe = lobe ? &*lobe : nullptr,
                            .seen = seen.weights()};

    const bool reduces = settings.gatherDivisor > 1;
    const ReducedGBuffer reduced =
        reduces ? log.run("pp reduce", kPicturePass, [&] { return reduceGBuffer(input.gbuffer, settings.gatherDivisor); }) : everyPixel(input.gbuffer);
    const Gathered light = log.run("pp gather", kPicturePass, [&] { return gatherFromCells(world, reduced, input.needs); });
    return reduces ? log.run("pp upsample", kPicturePass, [&] { return upsample(light, reduced, input.gbuffer); }) : light;
}

GatherMethod proxiesMethod()
{
    return {.reads = {}, .pixelByPixel = false, .gather = gatherProxies, .explain = explainProxies, .predict = predictProxies};
}

}  // namespace lrsm
