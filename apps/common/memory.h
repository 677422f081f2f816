#pragma once

#include "conetrace/render.h"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

/// Bytes before and after: what each structure will hold, what it held, and what Table 2 of the paper says.
namespace lrsm {

struct MemoryRow {
    std::string structure;                ///< "voxels", "rsm 0", "lrsm 0", "gbuffer"
    std::string detail;                   ///< "256^3, directional"
    std::size_t predicted = 0;            ///< held by this program
    std::size_t predictedGpu = 0;         ///< the same in the GPU's formats; 0: the paper names none
    std::string table2;                   ///< as printed, in the paper's megabytes of 10^6 bytes; empty: no such row
    std::optional<std::size_t> measured;  ///< after rendering
};

/// Layers that each light's LRSM keeps: found by rendering its RSM, which is cheap beside the rest. All layers when none are dropped.
std::vector<int> countLayersKept(const Scene& scene, const Requirements& needs, const Settings& settings);

/// `layersKept` has one entry a light.
std::vector<MemoryRow> predictMemory(const Settings& settings, const Requirements& needs, const std::vector<int>& layersKept, int width, int height);

/// All that is held at once while a frame is rendered, its pictures included: what enforceMemoryLimit holds against the limit.
std::size_t frameBytes(const Settings& settings, const Requirements& needs, const std::vector<int>& layersKept, int width, int height);

/// InputError, before anything large is allocated, when the frame needs more than `maxMegabytes` (of 10^6 bytes; 0: no limit). Decides
/// by bounds where they suffice: one layer a light, then all layers; only between the two are the layers counted.
void enforceMemoryLimit(const Scene& scene, const Requirements& needs, const Settings& settings, int width, int height, double maxMegabytes);

/// Fills in `measured` from the passes' reports.
void addMeasured(std::vector<MemoryRow>& rows, const Frame& frame);

nlohmann::ordered_json memoryJson(const std::vector<MemoryRow>& rows);
void printMemory(std::ostream& out, const std::vector<MemoryRow>& rows);

/// "19.2 MB", of 10^6 bytes as in the paper.
std::string megabytes(std::size_t bytes);

}  // namespace lrsm
