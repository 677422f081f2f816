#include "conetrace/caches/gather.h"

#include "conetrace/caches/explain.h"
#include "conetrace/caches/light_voxels.h"
#include "conetrace/caches/memory.h"
#include "conetrace/lrsm/gather.h"
#include "conetrace/vct/gather.h"

namespace lrsm {
namespace {

constexpr PassTraits kPixelsPassOn{.perPixel = true, .resident = false};  ///< grows with the pixels, and goes into a later pass's output

CacheAtlas fillByLrsm(const GatherInput& input, const CachePlaces& places, const CacheTables& tables, PassLog& log)
{
    const Settings& settings = input.settings;
    std::vector<Lrsm> own;
    const std::vector<Lrsm>& lrsms = layersOf(input, log, own);
    const ConeSettings cones = slabSettings(settings.cones);
    const NormalCdf phi(cones.gather.gaussian, cones.gather.gaussianTableSize);
    const ConeWorld world{.opacity = input.opacity, .lrsms = lrsms, .settings = cones, .phi = phi};
    return log.run("rc fill", kPixelsPassOn, [&] { return fillFromLrsm(places, tables, world, settings.caches, input.lanes); });
}

CacheAtlas fillByVct(const GatherInput& input, const CachePlaces& places, const CacheTables& tables, PassLog& log)
{
    const Settings& settings = input.settings;
    RadianceVolume own;
    const RadianceVolume& volume = radianceOf(input, log, own);
    const VctWorld world{.volume = volume, .grid = input.opacity.base.grid, .cones = settings.cones, .vct = settings.vct};
    return log.run("rc fill", kPixelsPassOn, [&] { return fillFromVct(places, tables, world, settings.caches, input.lanes); });
}

IsotropicVolume lightAndFilter(const GatherInput& input, PassLog& log)
{
    IsotropicVolume volume = [&] {
        const VoxelSurface surface = buildSurface(input, log);
        return log.run("rc light", kPassedOn, [&] { return lightVoxels(input, surface); });
    }();
    return log.run("rc mips", kWorldPass, [&] {
        prefilterRadiance(volume, input.settings.caches);
        return std::move(volume);
    });
}

CacheAtlas fillByVoxels(const GatherInput& input, const CachePlaces& places, const CacheTables& tables, PassLog& log)
{
    const Settings& settings = input.settings;
    const IsotropicVolume volume = lightAndFilter(input, log);
    const VoxelWorld world{.volume = volume, .grid = input.opacity.base.grid, .cones = settings.cones, .opacity = settings.vct.opacity};
    return log.run("rc fill", kPixelsPassOn, [&] { return fillFromVoxels(places, tables, world, settings.caches, input.lanes); });
}

CacheAtlas fill(const GatherInput& input, const CachePlaces& places, const CacheTables& tables, PassLog& log)
{
    switch (input.settings.caches.fill) {
    case CacheFill::vct: return fillByVct(input, places, tables, log);
    case CacheFill::voxels: return fillByVoxels(input, places, tables, log);
    case CacheFill::lrsm: break;
    }
    return fillByLrsm(input, places, tables, log);
}

WorldReads readsOf(const CacheSettings& settings)
{
    return {.bits = true, .mips = settings.fill == CacheFill::lrsm || (settings.fill == CacheFill::voxels && settings.shadow == CacheShadow::cone)};
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

GatherMethod cachesMethod(const CacheSettings& settings)
{
    return {.reads = readsOf(settings), .pixelByPixel = false, .gather = gatherCaches, .explain = explainCaches, .predict = predictCaches};
}

}  // namespace lrsm
