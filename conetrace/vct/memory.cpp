#include "conetrace/vct/memory.h"

#include "voxel/radiance/radiance_volume.h"
#include "voxel/voxelize.h"

namespace lrsm {
namespace {

std::size_t heldBytes(const MemoryQuestion& question)
{
    const VoxelSettings& voxels = question.settings.voxel;
    switch (question.unknowns) {
    case Unknowns::least: {
        BitGrid nothing;
        nothing.grid.resolution = voxels.resolution;
        nothing.bricks.assign(predictBitGridBytes(voxels.resolution) / sizeof(std::uint64_t), 0);
        return predictRadianceBytes(mapBricks(nothing));
    }
    case Unknowns::most: return predictDenseRadianceBytes(voxels.resolution);
    case Unknowns::found: break;
    }
    return predictRadianceBytes(mapBricks(voxelize(question.scene, voxels)));
}

}  // namespace

std::vector<MemoryRow> predictRadiance(const MemoryQuestion& question)
{
    const int n = question.settings.voxel.resolution;
    return {{.structure = "vct",
             .pass = "vct mips",
             .detail = std::to_string(n) + "^3, six directions",
             .predicted = heldBytes(question),
             .predictedGpu = RadianceVolume::predictGpuBytes(n),
             .table2 = n == 512 ? "3 GB" : "",
             .measured = {}}};
}

}  // namespace lrsm
