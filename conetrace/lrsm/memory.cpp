#include "conetrace/lrsm/memory.h"

#include "lrsm/layers.h"

namespace lrsm {
namespace {

int layersAsked(const LayerSettings& settings)
{
    return settings.depthLayers * settings.normalLayers;
}

std::string passOf(std::size_t light)
{
    return "lrsm " + std::to_string(light);
}

int layersOf(const MemoryQuestion& question, std::size_t light)
{
    if (light < question.layersKept.size()) return question.layersKept[light];
    if (question.rendered)
        for (const PassReport& report : *question.rendered)
            if (report.name == passOf(light)) return static_cast<int>(counterSum(report.counters, "layers_kept"));
    const Settings& settings = question.settings;
    if (!settings.layers.dropEmpty || question.unknowns == Unknowns::most) return layersAsked(settings.layers);
    if (question.unknowns == Unknowns::least) return 1;
    return countLayers(renderRsm(question.scene, question.scene.lights[light], question.needs, settings.rsm), settings.layers);
}

std::string table2(int baseResolution, int layers)
{
    if (baseResolution != 512) return "";
    return layers == 4 ? "33.6 MB" : layers == 6 ? "50.4 MB" : "";
}

}  // namespace

std::vector<int> layersKept(const MemoryQuestion& question)
{
    std::vector<int> kept;
    for (std::size_t light = 0; light < question.scene.lights.size(); ++light) kept.push_back(layersOf(question, light));
    return kept;
}

std::vector<MemoryRow> predictLrsms(const MemoryQuestion& question)
{
    const Settings& settings = question.settings;
    const int base = settings.rsm.resolution / 2;
    std::vector<MemoryRow> rows;
    for (std::size_t light = 0; light < question.scene.lights.size(); ++light) {
        const int layers = layersOf(question, light);
        const std::size_t bytes = static_cast<std::size_t>(layers) * predictLayerBytes(settings.rsm.resolution);
        rows.push_back({.structure = passOf(light),
                        .pass = passOf(light),
                        .detail = std::to_string(base) + "^2, " + std::to_string(layers) + " of " + std::to_string(layersAsked(settings.layers)) + " layers",
                        .predicted = bytes,
                        .predictedGpu = bytes / sizeof(LrsmTexel) * Lrsm::kGpuTexelBytes,
                        .table2 = table2(base, layers),
                        .measured = {}});
    }
    return rows;
}

}  // namespace lrsm
