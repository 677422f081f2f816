#include "apps/common/memory.h"

#include "core/base/errors.h"
#include "voxel/opacity_pyramid.h"

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <numeric>

namespace lrsm {

namespace {

/// One byte a voxel (D3D11 has no 1-bit format), full mip chains; three of them above the base level when directional.
std::size_t voxelGpuBytes(const VoxelSettings& settings)
{
    const std::size_t chains = settings.axes == OpacityAxes::directional ? 3 : 1;
    std::size_t bytes = 0;
    for (int resolution = settings.resolution, level = 0; resolution >= 1; resolution /= 2, ++level) {
        const auto edge = static_cast<std::size_t>(resolution);
        bytes += edge * edge * edge * (level == 0 ? 1 : chains);
    }
    return bytes;
}

std::string table2Voxels(int resolution)
{
    if (resolution == 256) return "19.2 MB";
    if (resolution == 512) return "156.4 MB (its format: 153.4)";
    return "";
}

std::string table2Lrsm(int baseResolution, int layers)
{
    if (baseResolution != 512) return "";
    return layers == 4 ? "33.6 MB" : layers == 6 ? "50.4 MB" : "";
}

/// The pictures and what fills them: six of the frame's, beside the G-buffer.
std::size_t pictureBytes(int width, int height)
{
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * (5 * sizeof(Vec3) + sizeof(float));
}

std::size_t total(const std::vector<MemoryRow>& rows)
{
    return std::accumulate(rows.begin(), rows.end(), std::size_t(0), [](std::size_t sum, const MemoryRow& row) { return sum + row.predicted; });
}

int layersAsked(const Settings& settings)
{
    return settings.layers.depthLayers * settings.layers.normalLayers;
}

/// Name of the pass whose output the row measures: the pyramid holds the base level too.
std::string passOf(const MemoryRow& row)
{
    return row.structure == "voxels" ? "voxel mips" : row.structure;
}

}  // namespace

std::string megabytes(std::size_t bytes)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f MB", static_cast<double>(bytes) * 1e-6);
    return text;
}

std::vector<int> countLayersKept(const Scene& scene, const Requirements& needs, const Settings& settings)
{
    std::vector<int> kept(scene.lights.size(), layersAsked(settings));
    if (!settings.layers.dropEmpty) return kept;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) kept[i] = countLayers(renderRsm(scene, scene.lights[i], needs, settings.rsm), settings.layers);
    return kept;
}

std::vector<MemoryRow> predictMemory(const Settings& settings, const Requirements& needs, const std::vector<int>& layersKept, int width, int height)
{
    const int voxels = settings.voxel.resolution, texels = settings.rsm.resolution, base = texels / 2;
    std::vector<MemoryRow> rows;
    rows.push_back({"voxels",
                    std::to_string(voxels) + "^3, " + (settings.voxel.axes == OpacityAxes::directional ? "directional" : "isotropic"),
                    predictPyramidBytes(settings.voxel),
                    voxelGpuBytes(settings.voxel),
                    table2Voxels(voxels),
                    {}});
    for (std::size_t i = 0; i < layersKept.size(); ++i)
        rows.push_back({"rsm " + std::to_string(i),
                        std::to_string(texels) + "^2",
                        Rsm::predictBytes(texels),
                        Rsm::gpuBytes(texels),
                        texels == 1024 ? "22.4 MB (with mips)" : "",
                        {}});
    for (std::size_t i = 0; i < layersKept.size(); ++i) {
        const auto layers = static_cast<std::size_t>(layersKept[i]);
        const std::size_t bytes = layers * predictLayerBytes(texels);
        rows.push_back({"lrsm " + std::to_string(i),
                        std::to_string(base) + "^2, " + std::to_string(layers) + " of " + std::to_string(layersAsked(settings)) + " layers",
                        bytes,
                        bytes / sizeof(LrsmTexel) * 24,
                        table2Lrsm(base, layersKept[i]),
                        {}});
    }
    rows.push_back({"gbuffer", std::to_string(width) + "x" + std::to_string(height), GBuffer::predictBytes(width, height, needs.specular), 0, "", {}});
    return rows;
}

std::size_t frameBytes(const Settings& settings, const Requirements& needs, const std::vector<int>& layersKept, int width, int height)
{
    return total(predictMemory(settings, needs, layersKept, width, height)) + pictureBytes(width, height);
}

void enforceMemoryLimit(const Scene& scene, const Requirements& needs, const Settings& settings, int width, int height, double maxMegabytes)
{
    if (maxMegabytes <= 0.0) return;
    const auto bytesWith = [&](const std::vector<int>& layers) { return frameBytes(settings, needs, layers, width, height); };
    const double limit = maxMegabytes * 1e6;
    if (static_cast<double>(bytesWith(std::vector<int>(scene.lights.size(), layersAsked(settings)))) <= limit) return;
    std::size_t needed = bytesWith(std::vector<int>(scene.lights.size(), 1));
    if (static_cast<double>(needed) <= limit) needed = bytesWith(countLayersKept(scene, needs, settings));
    if (static_cast<double>(needed) > limit) {
        char text[32];
        std::snprintf(text, sizeof text, "%g", maxMegabytes);
        throw InputError(std::string("--max-memory ") + text, "this frame needs " + megabytes(needed) +
                                                                  "; lower voxel_resolution, rsm_resolution, the layers or --size (lrsm info shows each part)");
    }
}

void addMeasured(std::vector<MemoryRow>& rows, const Frame& frame)
{
    for (MemoryRow& row : rows)
        for (const PassReport& pass : frame.passes)
            if (pass.name == passOf(row)) {
                row.measured = pass.bytes;
                if (row.predictedGpu == 0) row.predictedGpu = pass.gpuBytes;
            }
}

nlohmann::ordered_json memoryJson(const std::vector<MemoryRow>& rows)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const MemoryRow& row : rows) {
        nlohmann::ordered_json entry = {{"structure", row.structure}, {"detail", row.detail}, {"predicted_bytes", row.predicted}};
        if (row.measured) entry["measured_bytes"] = *row.measured;
        if (row.predictedGpu) entry["gpu_format_bytes"] = row.predictedGpu;
        if (!row.table2.empty()) entry["table2"] = row.table2;
        list.push_back(entry);
    }
    return list;
}

void printMemory(std::ostream& out, const std::vector<MemoryRow>& rows)
{
    const auto line = [&](const std::string& a, const std::string& b, const std::string& c, const std::string& d, const std::string& e) {
        out << "  " << std::left << std::setw(9) << a << std::setw(24) << b << std::right << std::setw(12) << c << std::setw(13) << d << "   " << e << "\n";
    };
    line("", "", "here", "GPU formats", "Table 2");
    std::size_t bytes = 0, gpuBytes = 0;
    for (const MemoryRow& row : rows) {
        line(row.structure, row.detail, megabytes(row.predicted), row.predictedGpu ? megabytes(row.predictedGpu) : "-", row.table2.empty() ? "-" : row.table2);
        bytes += row.predicted;
        gpuBytes += row.predictedGpu;
    }
    line("sum", "", megabytes(bytes), megabytes(gpuBytes), "");
}

}  // namespace lrsm
