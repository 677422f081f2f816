// The passes of method=caches run anew.
#include "apps/capture/caches_buffers.h"
#include "apps/capture/captured_world.h"
#include "apps/capture/map_buffers.h"
#include "apps/capture/picture_buffers.h"
#include "apps/capture/rerun.h"
#include "apps/capture/scene_buffers.h"
#include "apps/capture/vct_buffers.h"
#include "apps/capture/voxel_buffers.h"
#include "conetrace/caches/light_voxels.h"
#include "core/base/errors.h"

namespace lrsm {

namespace {

CacheTables tablesOf(const Capture& inputs)
{
    return makeCacheTables(inputs.settings.caches, inputs.settings.cones.set.rotation);
}

}  // namespace

void rerunClusters(const Capture& inputs, std::size_t, Rerun& made)
{
    toBuffers(clusterPixels(gbufferFromCapture(inputs), inputs.camera, inputs.settings.caches), made.outputs);
}

void rerunPlaces(const Capture& inputs, std::size_t, Rerun& made)
{
    const Settings& settings = inputs.settings;
    toBuffers(placeCaches(gbufferFromCapture(inputs), inputs.camera, clustersFromCapture(inputs), settings.caches, settings.cones.set.rotation), made.outputs);
}

void makeLitVoxels(const Capture& inputs, const Settings& settings, std::size_t, std::vector<Buffer>& outputs)
{
    CapturedWorld world;
    world.scene = sceneFromCapture(inputs);
    if (settings.caches.shadow == CacheShadow::rsm)
        world.rsms = mapsOf(inputs, rsmFromCapture);
    else
        world.opacity = opacityFromCapture(inputs);
    world.opacity.base = bitsFromCapture(inputs);
    litToBuffers(lightVoxels(world.input(inputs, settings), surfaceFromCapture(inputs, world.opacity.base)), outputs);
}

/// Each level from the level below as `inputs` has it.
void rerunVoxelRadiance(const Capture& inputs, std::size_t, Rerun& made)
{
    IsotropicVolume volume = isotropicFromCapture(inputs);
    // From the top down, so that what a level is made from is still the captured one.
    for (std::size_t level = volume.levels.size() - 1; level >= 1; --level) prefilterRadianceLevel(volume, level, inputs.settings.caches);
    prefilteredToBuffers(volume, made.outputs);
}

void rerunFill(const Capture& inputs, std::size_t, Rerun& made)
{
    const Settings& settings = inputs.settings;
    const CachePlaces places = placesFromCapture(inputs);
    const CacheTables tables = tablesOf(inputs);
    switch (settings.caches.fill) {
    case CacheFill::vct: {
        const RadianceVolume volume = radianceFromCapture(inputs);
        const VctWorld world{.volume = volume, .grid = inputs.grid, .cones = settings.cones, .vct = settings.vct};
        return filledToBuffers(fillFromVct(places, tables, world, settings.caches), made.outputs);
    }
    case CacheFill::voxels: {
        const IsotropicVolume volume = isotropicFromCapture(inputs);
        const VoxelWorld world{.volume = volume, .grid = inputs.grid, .cones = settings.cones, .opacity = settings.vct.opacity};
        return filledToBuffers(fillFromVoxels(places, tables, world, settings.caches), made.outputs);
    }
    case CacheFill::lrsm: break;
    }
    const ConeSettings cones = slabSettings(settings.cones);
    const OpacityPyramid opacity = opacityFromCapture(inputs);
    const std::vector<Lrsm> lrsms = mapsOf(inputs, lrsmFromCapture);
    const NormalCdf phi(cones.gather.gaussian, cones.gather.gaussianTableSize);
    const ConeWorld world{.opacity = opacity, .lrsms = lrsms, .settings = cones, .phi = phi};
    filledToBuffers(fillFromLrsm(places, tables, world, settings.caches), made.outputs);
}

/// Each level from the level below as `inputs` has it.
void rerunConvolve(const Capture& inputs, std::size_t, Rerun& made)
{
    CacheAtlas atlas = atlasFromCapture(inputs);
    const CacheTables tables = tablesOf(inputs);
    // From the top down, so that what a level is made from is still the captured one.
    for (int level = tables.levels() - 1; level >= 1; --level) fillCacheLevel(atlas, level, tables, inputs.settings.caches);
    foldCosine(atlas, tables, inputs.settings.caches);
    convolvedToBuffers(atlas, made.outputs);
}

void rerunCachedLight(const Capture& inputs, std::size_t, Rerun& made)
{
    const GBuffer gbuffer = gbufferFromCapture(inputs);
    const PixelClusters clusters = clustersFromCapture(inputs);
    const CachePlaces places = placesFromCapture(inputs);
    if (places.size() != clusters.size()) throw InputError("rc.pixel", "has another number of caches than rc.keys of clusters");
    for (std::size_t pixel = 0; pixel < gbuffer.objectId.texels.size(); ++pixel)
        if (gbuffer.covered(pixel) && clusters.clusterOf.texels[pixel] == 0) throw InputError("rc.cluster", "is 0 where gbuffer.object_id is not");
    const CacheAtlas atlas = atlasFromCapture(inputs);
    cachedLightToBuffers(
        evaluateCaches(
            {.gbuffer = gbuffer, .camera = inputs.camera, .clusters = clusters, .places = places, .atlas = atlas, .settings = inputs.settings.caches},
            inputs.needs),
        made.outputs);
}

}  // namespace lrsm
