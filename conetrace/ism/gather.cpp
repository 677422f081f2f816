#include "conetrace/ism/gather.h"

#include "conetrace/ism/explain.h"
#include "conetrace/ism/memory.h"

#include <optional>

namespace lrsm {

ImperfectLights buildImperfectLights(const GatherInput& input, PassLog& log)
{
    const Settings& settings = input.settings;
    const PointProxies points = log.run("pp place", kPassedOn, [&] { return placeProxies(input.scene, settings.proxies, settings.surface.textureFilter); });
    ImperfectLights out;
    out.lights = log.run("ism lights", kWorldPass, [&] { return drawLights(input.rsms, settings.ism); });
    out.maps = log.run("ism maps", kWorldPass, [&] { return renderMaps(out.lights, points, extentOf(input.scene), settings); });
    return out;
}

Gathered gatherIsm(const GatherInput& input, PassLog& log)
{
    const ImperfectLights made = buildImperfectLights(input, log);
    std::optional<VplLobeIntegral> lobe;
    if (input.needs.specular) lobe.emplace(input.settings.vpl);
    const IsmWorld world{.gbuffer = input.gbuffer,
                         .camera = input.camera,
                         .lights = made.lights,
                         .maps = made.maps,
                         .settings = input.settings.ism,
                         .vpl = input.settings.vpl,
                         .lobe = lobe ? &*lobe : nullptr};
    Gathered gathered = log.run("ism gather", kPicturePass, [&] { return gatherFromLights(world, input.needs); });
    gathered.filter4x4 = input.settings.ism.interleave && input.settings.cones.set.filter;
    return gathered;
}

GatherMethod ismMethod()
{
    return {.reads = {}, .pixelByPixel = true, .gather = gatherIsm, .explain = explainIsm, .predict = predictIsm};
}

}  // namespace lrsm
