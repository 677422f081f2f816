#include "conetrace/vct/memory.h"

#include "voxel/radiance/radiance_volume.h"
#include "voxel/voxelize.h"

namespace lrsm {

std::size_t predictHeldBricks(const MemoryQuestion& question, int base, int above)
{
    const VoxelSettings& voxels = question.settings.voxel;
    switch (question.unknowns) {
    case Unknowns::least: {
        BitGrid nothing;
        nothing.grid.resolution = voxels.resolution;
        nothing.bricks.assign(predictBitGridBytes(voxels.resolution) / sizeof(std::uint64_t), 0);
        return predictBrickBytes(mapBricks(nothing), base, above);
    }
    case Unknowns::most: return predictDenseBrickBytes(voxels.resolution, base, above);
    case Unknowns::found: break;
    }
    return predictBrickBytes(mapBricks(voxelize(question.scene, voxels)), base, above);
}

std::vector<MemoryRow> predictRadiance(const MemoryQuestion& question)
{
    const int n = question.settings.voxel.resolution;
    return {{.structure = "vct",
             .pass = "vct mips",
             .detail = std::to_string(n) + "^3, six directions",
             .predicted = predictHeldBricks(question, 2, kTravelDirections),
             .predictedGpu = RadianceVolume::predictGpuBytes(n),
             .table2 = n == 512 ? "3 GB" : "",
             .measured = {}}};
}

}  // namespace lrsm
