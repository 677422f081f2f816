// The passes of method=proxies and method=ism run anew.
#include "apps/capture/caches_buffers.h"
#include "apps/capture/captured_world.h"
#include "apps/capture/fill.h"
#include "apps/capture/map_buffers.h"
#include "apps/capture/picture_buffers.h"
#include "apps/capture/proxy_buffers.h"
#include "apps/capture/rerun.h"
#include "apps/capture/scene_buffers.h"
#include "core/base/errors.h"

#include <numeric>
#include <optional>

namespace lrsm {

void rerunProxies(const Capture& inputs, std::size_t, Rerun& made)
{
    toBuffers(placeProxies(wholeScene(inputs), inputs.settings.proxies, inputs.settings.surface.textureFilter), made.outputs);
}

void rerunProxyLight(const Capture& inputs, std::size_t, Rerun& made)
{
    CapturedWorld world;
    world.scene = sceneFromCapture(inputs);
    world.rsms = mapsOf(inputs, rsmFromCapture);
    toBuffers(lightProxies(world.input(inputs, inputs.settings), proxiesFromCapture(inputs)), made.outputs);
}

void rerunProxyCells(const Capture& inputs, std::size_t, Rerun& made)
{
    const PointProxies proxies = proxiesFromCapture(inputs);
    const ProxyLight light = proxyLightFromCapture(inputs);
    if (light.radiance.size() != proxies.size()) throw InputError("pp.radiance", "has another number of proxies than pp.position");
    toBuffers(sortProxies(sceneFromCapture(inputs), proxies, light, inputs.settings.proxies), made.outputs);
}

void rerunProxyMarch(const Capture& inputs, std::size_t, Rerun& made)
{
    const GBuffer gbuffer = gbufferFromCapture(inputs);
    const ProxyCells cells = proxyCellsFromCapture(inputs);
    const ConeSet rays = shadowRays(inputs.settings.proxies);
    toBuffers(marchShadowRays({.gbuffer = gbuffer,
                               .camera = inputs.camera,
                               .cells = cells,
                               .rays = rays,
                               .settings = inputs.settings.proxies,
                               .specular = inputs.needs.specular}),
              kMarched, made.outputs);
}

void rerunProxyFilter(const Capture& inputs, std::size_t, Rerun& made)
{
    const ProxyCells cells = proxyCellsFromCapture(inputs);
    toBuffers(filterVisibility(listsFromCapture(inputs, kMarched, cells.grid.count()), gbufferFromCapture(inputs), cells, inputs.settings.proxies),
              kFilteredLists, made.outputs);
}

void rerunWeighProxies(const Capture& inputs, std::size_t, Rerun& made)
{
    const ProxyCells cells = proxyCellsFromCapture(inputs);
    toBuffers(weighProxies(cells, copyFrom<std::uint32_t>(inputs, kProxyHits, Dtype::u4, cells.numbers.size())), made.outputs);
}

void rerunProxyGather(const Capture& inputs, std::size_t, Rerun& made)
{
    const Settings& settings = inputs.settings;
    const GBuffer gbuffer = gbufferFromCapture(inputs);
    const ProxyCells cells = proxyCellsFromCapture(inputs);
    const VisibilityLists lists = listsFromCapture(inputs, settings.proxies.filterRadius > 0 ? kFilteredLists : kMarched, cells.grid.count());
    std::optional<VplLobeIntegral> lobe;
    if (inputs.needs.specular) lobe.emplace(settings.vpl);
    std::optional<WeighedProxies> seen;
    if (settings.proxies.cellWeight == ProxyCellWeight::seen) seen = weighedFromCapture(inputs, cells);
    const GatherWorld world{.gbuffer = gbuffer,
                            .camera = inputs.camera,
                            .cells = cells,
                            .lists = lists,
                            .settings = settings.proxies,
                            .vpl = settings.vpl,
                            .lobe = lobe ? &*lobe : nullptr,
                            .seen = seen ? &*seen : nullptr};
    cachedLightToBuffers(gatherFromCells(world, everyPixel(gbuffer), inputs.needs), made.outputs);
}

void rerunIsmLights(const Capture& inputs, std::size_t, Rerun& made)
{
    toBuffers(drawLights(mapsOf(inputs, rsmFromCapture), inputs.settings.ism), made.outputs);
}

void rerunIsmMaps(const Capture& inputs, std::size_t, Rerun& made)
{
    toBuffers(renderMaps(virtualLightsFromCapture(inputs), proxiesFromCapture(inputs), extentOf(sceneFromCapture(inputs)), inputs.settings), made.outputs);
}

void rerunIsmGather(const Capture& inputs, std::size_t, Rerun& made)
{
    const GBuffer gbuffer = gbufferFromCapture(inputs);
    const VirtualLights lights = virtualLightsFromCapture(inputs);
    const ImperfectMaps maps = imperfectMapsFromCapture(inputs);
    if (maps.depth.size() != lights.lights.size() * maps.texels()) throw InputError("ism.depth", "has another number of maps than ism.lights has lights");
    std::optional<VplLobeIntegral> lobe;
    if (inputs.needs.specular) lobe.emplace(inputs.settings.vpl);
    cachedLightToBuffers(gatherFromLights({.gbuffer = gbuffer,
                                           .camera = inputs.camera,
                                           .lights = lights,
                                           .maps = maps,
                                           .settings = inputs.settings.ism,
                                           .vpl = inputs.settings.vpl,
                                           .lobe = lobe ? &*lobe : nullptr},
                                          inputs.needs),
                         made.outputs);
}

}  // namespace lrsm
