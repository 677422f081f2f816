#include "conetrace/frame/receiver.h"

#include "conetrace/frame/cones.h"
#include "voxel/cascades.h"

namespace lrsm {

Receiver receiverAt(const GBuffer& gbuffer, const VoxelGrid& grid, const ConeSettings& settings, int x, int y)
{
    const std::size_t pixel = gbuffer.position.index(x, y);
    Receiver receiver;
    receiver.position = gbuffer.position.texels[pixel];
    receiver.geometricNormal = gbuffer.geometricNormal.texels[pixel];
    receiver.normal = gbuffer.normal.texels[pixel];
    receiver.originWorld = receiver.position + receiver.geometricNormal * (settings.march.normalOffsetVoxels * grid.voxelSize);
    receiver.originVoxels = grid.voxelsFromWorld(receiver.originWorld);
    receiver.rotation = rotationOfPixel(x, y, settings.set.rotation);
    return receiver;
}

int cascadeOfPixel(const GBuffer& gbuffer, const OpacityPyramid& finest, const ConeSettings& settings, int x, int y)
{
    const float threshold = (float(rotationOfPixel(x, y, settings.set.rotation)) + 0.5f) / float(kRotations);
    return cascadeOfReceiver(finest, gbuffer.position.at(x, y), threshold);
}

}  // namespace lrsm
