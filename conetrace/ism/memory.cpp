#include "conetrace/ism/memory.h"

#include "conetrace/ism/maps.h"

namespace lrsm {

std::vector<MemoryRow> predictIsm(const MemoryQuestion& question)
{
    const IsmSettings& settings = question.settings.ism;
    // Maps without light have no virtual ones.
    std::size_t lights = question.unknowns == Unknowns::least || question.scene.lights.empty() ? 0 : std::size_t(settings.lights);
    if (question.rendered) lights = std::size_t(counterSum(*question.rendered, "virtual_lights"));
    const auto n = std::size_t(settings.resolution);
    VirtualLights one;
    one.lights.resize(1);
    ImperfectMaps map;
    map.unorm = settings.storage == Storage::gpu;
    map.depth.resize(n * n);
    return {{.structure = "lights",
             .pass = "ism lights",
             .detail = std::to_string(lights),
             .predicted = lights * bytesOf(one),
             .predictedGpu = lights * gpuBytesOf(one),
             .table2 = "",
             .measured = {}},
            {.structure = "maps",
             .pass = "ism maps",
             .detail = std::to_string(lights) + " of " + std::to_string(n) + "^2",
             .predicted = lights * bytesOf(map),
             .predictedGpu = lights * gpuBytesOf(map),
             .table2 = "",
             .measured = {}}};
}

}  // namespace lrsm
