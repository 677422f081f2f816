#include "conetrace/caches/gather.h"

#include "conetrace/caches/explain.h"
#include "conetrace/caches/memory.h"
#include "conetrace/lrsm/gather.h"

namespace lrsm {
namespace {

constexpr PassTraits kPixelsPassOn{.perPixel = true, .resident = false};  ///< grows with the pixels, and goes into a later pass's output

CacheAtlas fill(const GatherInput& input, const CachePlaces& places, const CacheTables& tables, PassLog& log)
{
    const Settings& settings = input.settings;
    std::vector<Lrsm> own;
    const std::vector<Lrsm>& lrsms = layersOf(input, log, own);
    const ConeSettings cones = slabSettings(settings.cones);
    const NormalCdf phi(cones.gather.gaussian, cones.gather.gaussianTableSize);
    const ConeWorld world{.opacity = input.opacity, .lrsms = lrsms, .settings = cones, .phi = phi};
    return log.run("rc fill", kPixelsPassOn, [&] { return fillFromLrsm(places, tables, world, settings.caches, input.lanes); });
}

}  // namespace

Caches buildCaches(const GatherInput& input, PassLog& log)
{
    const CacheSettings& settings = input.settings.caches;
    Caches caches;
    caches.clusters = log.run("rc clusters", kSurfacePass, [&] { return clusterPixels(input.gbuffer, input.camera, settings); });
    caches.places = log.run("rc places", kSurfacePass,
                            [&] { return placeCaches(input.gbuffer, input.camera, caches.clusters, settings, input.settings.cones.set.rotation); });
    const CacheTables tables = makeCacheTables(settings, input.settings.cones.set.rotation);
    CacheAtlas filled = fill(input, caches.places, tables, log);
    caches.atlas = log.run("rc convolve", kSurfacePass, [&] { return convolveCaches(std::move(filled), tables, settings); });
    return caches;
}

Gathered gatherCaches(const GatherInput& input, PassLog& log)
{
    const Caches caches = buildCaches(input, log);
    const CacheWorld world{.gbuffer = input.gbuffer,
                           .camera = input.camera,
                           .clusters = caches.clusters,
                           .places = caches.places,
                           .atlas = caches.atlas,
                           .settings = input.settings.caches};
    Gathered gathered = log.run("rc gather", kPicturePass, [&] { return evaluateCaches(world, input.needs); });
    log.show("rc gather", caches);
    gathered.filter4x4 = input.settings.cones.set.filter;
    return gathered;
}

GatherMethod cachesMethod()
{
    return {.reads = {.bits = true, .mips = true}, .pixelByPixel = false, .gather = gatherCaches, .explain = explainCaches, .predict = predictCaches};
}

}  // namespace lrsm
