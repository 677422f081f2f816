#include "conetrace/frame/memory.h"

#include "conetrace/frame/gbuffer.h"
#include "lrsm/depth_map.h"
#include "lrsm/rsm.h"
#include "voxel/opacity_pyramid.h"

namespace lrsm {
namespace {

std::string cube(int resolution)
{
    return std::to_string(resolution) + "^3, ";
}

std::string table2Voxels(int resolution)
{
    if (resolution == 256) return "19.2 MB";
    if (resolution == 512) return "156.4 MB (its format: 153.4)";
    return "";
}

}  // namespace

std::vector<MemoryRow> predictVoxels(const VoxelSettings& settings, bool bits, bool mips)
{
    MemoryRow row{.structure = "voxels", .pass = mips ? "voxel mips" : "voxelize", .detail = {}, .table2 = {}, .measured = {}};
    if (mips) {
        row.detail = cube(settings.resolution) + (settings.axes == OpacityAxes::directional ? "directional" : "isotropic");
        row.predicted = predictPyramidBytes(settings);
        row.predictedGpu = predictPyramidGpuBytes(settings);
        row.table2 = table2Voxels(settings.resolution);
    } else if (bits) {
        row.detail = cube(settings.resolution) + "bits";
        row.predicted = predictBitGridBytes(settings.resolution);
        row.predictedGpu = predictBitGridGpuBytes(settings.resolution);
    } else {
        return {};
    }
    std::vector<MemoryRow> rows(std::size_t(settings.cascades), row);
    for (int finer = 0; finer < settings.cascades; ++finer) {
        rows[std::size_t(finer)].structure += cascadeSuffix(finer);
        rows[std::size_t(finer)].pass += cascadeSuffix(finer);
    }
    return rows;
}

std::vector<MemoryRow> predictShadowMaps(const Settings& settings, std::size_t lights)
{
    std::vector<MemoryRow> rows;
    if (!hasShadowMaps(settings.direct)) return rows;
    const int resolution = settings.rsm.resolution * settings.direct.shadowResolution;
    for (std::size_t light = 0; light < lights; ++light) {
        const std::string pass = "shadow " + std::to_string(light);
        rows.push_back({.structure = pass,
                        .pass = pass,
                        .detail = std::to_string(resolution) + "^2",
                        .predicted = DepthMap::predictBytes(resolution),
                        .predictedGpu = DepthMap::predictBytes(resolution),
                        .table2 = "",
                        .measured = {}});
    }
    return rows;
}

std::vector<MemoryRow> predictRsms(const RsmSettings& settings, std::size_t lights)
{
    std::vector<MemoryRow> rows;
    for (std::size_t light = 0; light < lights; ++light) {
        const std::string pass = "rsm " + std::to_string(light);
        rows.push_back({.structure = pass,
                        .pass = pass,
                        .detail = std::to_string(settings.resolution) + "^2",
                        .predicted = Rsm::predictBytes(settings.resolution),
                        .predictedGpu = Rsm::predictGpuBytes(settings.resolution),
                        .table2 = settings.resolution == 1024 ? "22.4 MB (with mips)" : "",
                        .measured = {}});
    }
    return rows;
}

MemoryRow predictGBuffer(const MemoryQuestion& question)
{
    return {.structure = "gbuffer",
            .pass = "gbuffer",
            .detail = std::to_string(question.width) + "x" + std::to_string(question.height),
            .predicted = GBuffer::predictBytes(question.width, question.height, question.needs.specular),
            .table2 = {},
            .measured = {}};
}

std::size_t frameBytes(const std::vector<MemoryRow>& rows, int width, int height)
{
    // Direct, irradiance, specular, the composite's two parts and their sum share five pictures at a time; and the opacity.
    constexpr std::size_t kPictureBytes = 5 * sizeof(Vec3) + sizeof(float);
    std::size_t bytes = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * kPictureBytes;
    for (const MemoryRow& row : rows) bytes += row.predicted;
    return bytes;
}

void addMeasured(std::vector<MemoryRow>& rows, const std::vector<PassReport>& passes)
{
    for (MemoryRow& row : rows)
        for (const PassReport& pass : passes)
            if (pass.name == row.pass) {
                row.measured = pass.bytes;
                if (row.predictedGpu == 0) row.predictedGpu = pass.gpuBytes;
            }
}

}  // namespace lrsm
