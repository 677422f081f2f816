#include "conetrace/proxies/explain.h"

#include "conetrace/frame/pixel_text.h"
#include "conetrace/proxies/gather.h"

#include <algorithm>
#include <optional>
#include <span>

namespace lrsm {
namespace {

constexpr std::size_t kShownCells = 24, kShownProxies = 8;

std::string listsText(const GatherWorld& world, const VisibilityLists& marched, const ListWeights& weights)
{
    const Blocks blocks{world.gbuffer.width, world.gbuffer.height, world.lists.divisor};
    std::string text =
        formatted("\nlists of the four blocks of %d pixels about it, weights of Eq. 5\n      pixel     weight  cells  before the filter\n", blocks.divisor);
    for (std::size_t k = 0; k < 4; ++k) {
        if (!(weights.weight[k] > 0.0f)) continue;
        const auto column = int(weights.block[k]) % blocks.columns(), row = int(weights.block[k]) / blocks.columns();
        text += formatted("  %5d,%-5d  %.5f  %5zu  %5zu\n", blocks.middle(column, blocks.width), blocks.middle(row, blocks.height), double(weights.weight[k]),
                          world.lists.of(weights.block[k]).size(), marched.of(weights.block[k]).size());
    }
    return text;
}

IVec3 cellOf(const CellGrid& grid, std::uint32_t hash)
{
    const auto h = static_cast<int>(hash);
    return {h % grid.size.x, h / grid.size.x % grid.size.y, h / (grid.size.x * grid.size.y)};
}

/// A cell that the pixel reads, and what it gives.
struct ListedCell {
    std::uint32_t cell;
    float weight, share;
    bool near;
    Vec3 irradiance;
    float sum() const { return irradiance.x + irradiance.y + irradiance.z; }
};

/// Those in which something shines, brightest first.
std::vector<ListedCell> listedCells(const GatherWorld& world, const ListWeights& weights, const LitSurface& surface)
{
    const ProxyCells& cells = world.cells;
    std::vector<ListedCell> listed;
    forListedCells(world.lists, weights, [&](std::uint32_t cell, float weight, float share) {
        if (!(world.light(cell).litArea > 0.0f)) return;
        const bool near = isNear(world, cell, surface.position);
        const WholeCell whole =
            near ? cellByProxies(cells, world.seen, cell, cells.first[cell + 1], surface, world.vpl) : cellByHarmonics(world.light(cell), surface, world.vpl);
        listed.push_back({cell, weight, share, near, irradianceOfListed(world, cell, whole, weight, share) / cells.preExposure});
    });
    std::stable_sort(listed.begin(), listed.end(), [](const ListedCell& a, const ListedCell& b) { return a.sum() > b.sum(); });
    return listed;
}

std::string cellsText(const GatherWorld& world, const std::vector<ListedCell>& listed, const LitSurface& surface)
{
    const ProxyCells& cells = world.cells;
    std::string text =
        "\ncells in them that shine, brightest first, and the part of the rays that met each; irradiance by their proxies, or by their spherical harmonics "
        "beyond "
        "pp_range (Eq. 6)\n       cell  weight  met      distance  lit  unlit  by         irradiance\n";
    const std::size_t shown = std::min(listed.size(), kShownCells);
    for (const ListedCell& own : std::span(listed).first(shown)) {
        const IVec3 at = cellOf(cells.grid, own.cell);
        std::size_t lit = 0, unlit = 0;
        for (std::size_t slot = std::size_t(cells.first[own.cell]) * 4; slot < std::size_t(cells.first[own.cell + 1]) * 4; ++slot)
            if (cells.numbers[slot] != kNoProxy) ++(slot < std::size_t(cells.litEnd[own.cell]) * 4 ? lit : unlit);
        text += formatted("  %3d,%3d,%3d  %.4f  %.5f  %8.4f  %4zu  %4zu  %s  %.4g %.4g %.4g\n", at.x, at.y, at.z, double(own.weight), double(own.share),
                          double(glm::length(world.light(own.cell).centroid - surface.position)), lit, unlit, own.near ? "proxies  " : "harmonics",
                          double(own.irradiance.x), double(own.irradiance.y), double(own.irradiance.z));
    }
    Vec3 rest(0.0f);
    for (const ListedCell& own : std::span(listed).subspan(shown)) rest += own.irradiance;
    return text + formatted("  and %zu more: %.4g %.4g %.4g\n", listed.size() - shown, double(rest.x), double(rest.y), double(rest.z));
}

std::string proxiesText(const GatherWorld& world, const LitSurface& surface, std::uint32_t cell)
{
    const ProxyCells& cells = world.cells;
    const VplNear near = vplNear(world.vpl, cells.area);
    const IVec3 at = cellOf(cells.grid, cell);
    std::string text = formatted("\nfirst proxies of the brightest near cell, %d,%d,%d: each of %.5g m^2\n", at.x, at.y, at.z, double(cells.area));
    text += "   proxy  position                    normal                      cos cos'/(d^2+r^2)  radiance\n";
    std::size_t shown = 0;
    for (std::size_t slot = std::size_t(cells.first[cell]) * 4; slot < std::size_t(cells.litEnd[cell]) * 4 && shown < kShownProxies; ++slot) {
        if (cells.numbers[slot] == kNoProxy) continue;
        ++shown;
        const ProxyQuad& q = cells.quads[slot / 4];
        const std::size_t k = slot & 3;
        const Vec3 p(q.x[k], q.y[k], q.z[k]), n(q.nx[k], q.ny[k], q.nz[k]), radiance = Vec3(q.red[k], q.green[k], q.blue[k]) / cells.preExposure;
        text += formatted("  %6u  %8.4f %8.4f %8.4f  %8.4f %8.4f %8.4f  %.5g  %.4g %.4g %.4g\n", cells.numbers[slot], double(p.x), double(p.y), double(p.z),
                          double(n.x), double(n.y), double(n.z), double(vplGeometry(near, p - surface.position, surface.normal, n)), double(radiance.x),
                          double(radiance.y), double(radiance.z));
    }
    return text;
}

}  // namespace

std::string explainProxies(const GatherInput& input, int x, int y)
{
    const GBuffer& gbuffer = input.gbuffer;
    const std::size_t pixel = gbuffer.position.index(x, y);
    if (!gbuffer.covered(pixel)) return nothingDrawnText(x, y);
    const PassWatch nobody{.hashPasses = false, .progress = {}, .observe = {}};
    PassLog log(nobody);
    const ProxyCells cells = buildProxyCells(input, log);
    const ProxyVisibility seen = seeCells(input, cells, log);
    std::optional<VplLobeIntegral> lobe;
    if (input.needs.specular) lobe.emplace(input.settings.vpl);
    const GatherWorld world{.gbuffer = gbuffer,
                            .camera = input.camera,
                            .cells = cells,
                            .lists = seen.lists(),
                            .settings = input.settings.proxies,
                            .vpl = input.settings.vpl,
                            .lobe = lobe ? &*lobe : nullptr,
                            .seen = seen.weights()};
    const LitSurface surface{.position = gbuffer.position.texels[pixel], .normal = gbuffer.normal.texels[pixel]};
    const ListWeights weights = listWeights(gbuffer, world.lists.divisor, x, y);

    std::string text = receiverText(gbuffer, receiverAt(gbuffer, input.opacity.base.grid, input.settings.cones, x, y), x, y);
    text +=
        formatted("%d x %d x %d cells of %.5g m; it lies in %d,%d,%d\n", cells.grid.size.x, cells.grid.size.y, cells.grid.size.z, double(cells.grid.cellSize),
                  cells.grid.cellAt(surface.position).x, cells.grid.cellAt(surface.position).y, cells.grid.cellAt(surface.position).z);
    text += listsText(world, seen.marched, weights);
    const std::vector<ListedCell> listed = listedCells(world, weights, surface);
    text += cellsText(world, listed, surface);
    const auto brightestNear = std::find_if(listed.begin(), listed.end(), [](const ListedCell& own) { return own.near; });
    if (brightestNear != listed.end()) text += proxiesText(world, surface, brightestNear->cell);
    const ProxyPixel light = gatherProxyPixel(world, input.needs.specular, x, y);
    text += formatted("\nirradiance %.6g %.6g %.6g, opacity %.5f, of %llu cells that shine\n", double(light.irradiance.x), double(light.irradiance.y),
                      double(light.irradiance.z), double(light.opacity), static_cast<unsigned long long>(light.cells));
    if (input.needs.specular && gbuffer.specularColor.texels[pixel] != Vec3(0.0f))
        text += formatted("specular lobe of exponent %.4g: I = %.6g %.6g %.6g\n", double(phongExponent(gbuffer.roughness.texels[pixel])),
                          double(light.specular.x), double(light.specular.y), double(light.specular.z));
    return text + originText(input.scene);
}

}  // namespace lrsm
