// The passes of method=vct run anew.
#include "apps/capture/captured_world.h"
#include "apps/capture/map_buffers.h"
#include "apps/capture/picture_buffers.h"
#include "apps/capture/rerun.h"
#include "apps/capture/scene_buffers.h"
#include "apps/capture/vct_buffers.h"
#include "apps/capture/voxel_buffers.h"
#include "conetrace/vct/inject.h"

namespace lrsm {

void rerunVctSurface(const Capture& inputs, std::size_t, Rerun& made)
{
    const BitGrid bits = bitsFromCapture(inputs);
    const VoxelSurface surface = voxelSurface(wholeScene(inputs), bits, inputs.settings.voxel, inputs.settings.surface.textureFilter);
    toBuffers(PlacedSurface{bits, surface}, made.outputs);
}

void makeVctBase(const Capture& inputs, const Settings& settings, std::size_t, std::vector<Buffer>& outputs)
{
    CapturedWorld world;
    world.scene = sceneFromCapture(inputs);
    world.rsms = mapsOf(inputs, rsmFromCapture);
    world.opacity.base = bitsFromCapture(inputs);
    VoxelSurface surface;
    if (readsSurface(settings.vct)) surface = surfaceFromCapture(inputs, world.opacity.base);
    baseToBuffers(injectRadiance(world.input(inputs, settings), readsSurface(settings.vct) ? &surface : nullptr), outputs);
}

/// Each level from the level below as `inputs` has it.
void rerunVctMips(const Capture& inputs, std::size_t, Rerun& made)
{
    RadianceVolume volume = radianceFromCapture(inputs);
    // From the top down, so that what a level is made from is still the captured one.
    for (std::size_t level = volume.maps.size() - 1; level >= 1; --level) buildRadianceLevel(volume, level, inputs.settings.vct);
    mipsToBuffers(volume, made.outputs);
}

void rerunVctCones(const Capture& inputs, std::size_t, Rerun& made)
{
    CapturedWorld world;
    world.gbuffer = gbufferFromCapture(inputs);
    world.opacity.base.grid = inputs.grid;
    ConeRecord record;
    toBuffers(traceRadiance(world.input(inputs, inputs.settings), radianceFromCapture(inputs), &record), made.outputs);
    toBuffers(record, made.outputs);
}

}  // namespace lrsm
