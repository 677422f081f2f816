#include "conetrace/proxies/memory.h"

#include "conetrace/proxies/gather.h"

namespace lrsm {
namespace {

const PassReport* reportOf(const MemoryQuestion& question, const std::string& pass)
{
    if (!question.rendered) return nullptr;
    for (const PassReport& report : *question.rendered)
        if (report.name == pass) return &report;
    return nullptr;
}

/// Cells that hold proxies: these are placed for it, since neither the grid nor their number comes near it (a tenth to a half of the smaller).
std::size_t occupiedCells(const MemoryQuestion& question, const CellGrid& grid)
{
    const Settings& settings = question.settings;
    const PointProxies proxies = placeProxies(question.scene, settings.proxies, settings.surface.textureFilter);
    CellSet seen(grid.count());
    for (const Vec3& position : proxies.positions) seen.add(grid.hash(grid.cellAt(position)), 1);
    VisibilityLists all;
    seen.moveTo(all);
    return all.cells.size();
}

/// Two quads a cell may not be full.
std::size_t quadsOf(const MemoryQuestion& question, std::size_t occupied)
{
    const PassReport* found = reportOf(question, "pp cells");
    return found ? std::size_t(counterSum(found->counters, "quads")) : std::size_t(question.settings.proxies.count) / 4 + 2 * occupied;
}

MemoryRow cellsRow(const MemoryQuestion& question, const CellGrid& grid, std::size_t occupied)
{
    const ProxySettings& settings = question.settings.proxies;
    const std::size_t quads = quadsOf(question, occupied);
    ProxyCells like;
    like.half = settings.storage == Storage::gpu;
    const std::size_t proxyGpu = 16 + (like.half ? 8u : 16u),
                      tables = (2 * grid.count() + 1) * sizeof(std::uint32_t) + grid.count() * (sizeof(CellLight) + sizeof(Aabb));
    return {
        .structure = "proxies",
        .pass = "pp cells",
        .detail = std::to_string(settings.count) + " in " + std::to_string(grid.size.x) + "x" + std::to_string(grid.size.y) + "x" + std::to_string(grid.size.z),
        .predicted = tables + quads * (sizeof(ProxyQuad) + 4 * sizeof(std::uint32_t)),
        .predictedGpu = tables + quads * 4 * proxyGpu,
        .table2 = "",
        .measured = {}};
}

MemoryRow listsRow(const MemoryQuestion& question, const std::string& pass, const std::string& structure, std::size_t mostACell, std::size_t besides = 0)
{
    const Blocks blocks{question.width, question.height, question.settings.proxies.marchDivisor};
    const std::size_t count = std::size_t(blocks.columns()) * std::size_t(blocks.rows());
    const PassReport* found = reportOf(question, pass);
    const std::size_t cells = found ? std::size_t(counterSum(found->counters, "listed_cells")) : question.unknowns == Unknowns::least ? 0 : count * mostACell;
    const std::size_t bytes = (count + 1 + 2 * cells) * sizeof(std::uint32_t) + count * (2 * sizeof(float) + sizeof(std::uint32_t)) + besides;
    return {.structure = structure,
            .pass = pass,
            .detail = std::string(found ? "" : "up to ") + std::to_string(cells) + " cells",
            .predicted = bytes,
            .predictedGpu = bytes,
            .table2 = "",
            .measured = {}};
}

}  // namespace

std::vector<MemoryRow> predictProxies(const MemoryQuestion& question)
{
    const ProxySettings& settings = question.settings.proxies;
    const CellGrid grid = makeCellGrid(extentOf(question.scene), settings.grid);
    const std::size_t rays = std::size_t(settings.rays + (question.needs.specular ? settings.lobeRays : 0));
    const std::size_t occupied = question.rendered || question.unknowns == Unknowns::least ? 0 : occupiedCells(question, grid);
    std::vector<MemoryRow> rows = {cellsRow(question, grid, occupied)};
    const bool weighs = settings.cellWeight == ProxyCellWeight::seen;
    const std::size_t slots = 4 * quadsOf(question, occupied);
    rows.push_back(listsRow(question, "pp march", "lists", std::min(rays, occupied), weighs ? slots * sizeof(std::uint32_t) : 0));
    if (settings.filterRadius > 0) {
        const auto window = std::size_t(2 * settings.filterRadius + 1);
        rows.push_back(listsRow(question, "pp filter", "filtered", std::min(rays * window * window, occupied)));
    }
    if (weighs) {
        const std::size_t bytes = slots * sizeof(float) + grid.count() * sizeof(CellLight);
        rows.push_back({.structure = "weights", .pass = "pp weigh", .detail = "", .predicted = bytes, .predictedGpu = bytes, .table2 = "", .measured = {}});
    }
    return rows;
}

}  // namespace lrsm
