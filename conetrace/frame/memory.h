#pragma once

#include "conetrace/frame/pass_log.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

/// What a frame will hold, predicted before anything is allocated, and what it held.
namespace lrsm {

struct MemoryRow {
    std::string structure;                ///< "voxels", "rsm 0", "lrsm 0", "gbuffer"
    std::string pass;                     ///< whose output it is, as in PassReport
    std::string detail;                   ///< "256^3, directional"
    std::size_t predicted = 0;            ///< held by this program
    std::size_t predictedGpu = 0;         ///< the same in the GPU's formats; 0: the paper names none
    std::string table2;                   ///< as the paper prints it, in megabytes of 10^6 bytes; empty: no such row
    std::optional<std::size_t> measured;  ///< after rendering
};

/// How to take what only rendering can tell, as the number of layers that hold light.
enum class Unknowns { least, found, most };

struct MemoryQuestion {
    const Scene& scene;
    const Requirements& needs;
    const Settings& settings;
    int width = 0, height = 0;
    Unknowns unknowns = Unknowns::found;
    std::vector<int> layersKept = {};                   ///< of each light's LRSM, where known: then they need not be found
    const std::vector<PassReport>* rendered = nullptr;  ///< of this very frame, where there is one: the same
};

/// After the names of a cascade's passes and rows: none for the widest, which a lone grid is too; " 1", " 2" for those 2, 4 times as fine.
inline std::string cascadeSuffix(int finer)
{
    return finer == 0 ? "" : " " + std::to_string(finer);
}

/// The voxels, a row a cascade: their bits and mips, or the bits alone; none where neither is read.
std::vector<MemoryRow> predictVoxels(const VoxelSettings& settings, bool bits, bool mips);
/// A reflective shadow map a light.
std::vector<MemoryRow> predictRsms(const RsmSettings& settings, std::size_t lights);
/// The depth maps beside the RSMs, where shadow_resolution asks for them.
std::vector<MemoryRow> predictShadowMaps(const Settings& settings, std::size_t lights);
MemoryRow predictGBuffer(const MemoryQuestion& question);

/// All that is held at once while a frame is rendered, its pictures included.
std::size_t frameBytes(const std::vector<MemoryRow>& rows, int width, int height);

/// Fills in `measured`.
void addMeasured(std::vector<MemoryRow>& rows, const std::vector<PassReport>& passes);

}  // namespace lrsm
