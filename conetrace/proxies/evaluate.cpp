#include "conetrace/proxies/evaluate.h"

#include "conetrace/frame/tiles.h"
#include "core/scene/brdf.h"

#include <cmath>

namespace lrsm {
namespace {

constexpr float kLog2E = 1.44269504f;

Float4 positivePart(const Float4& v)
{
    return v > splat(0.0f) ? v : splat(0.0f);
}
Float4 atLeast(const Float4& v, float least)
{
    return v < splat(least) ? splat(least) : v;
}
Float4 atMost(const Float4& v, float most)
{
    return v > splat(most) ? splat(most) : v;
}
float sumOf(const Float4& v)
{
    return (v[0] + v[1]) + (v[2] + v[3]);
}

/// A quad as a surface sees it: where to, how far, and the cosines times the distance.
struct QuadView {
    Float4 dx, dy, dz, distance2, receiver, light;

    QuadView(const ProxyQuad& quad, const LitSurface& surface)
        : dx(quad.x - surface.position.x),
          dy(quad.y - surface.position.y),
          dz(quad.z - surface.position.z),
          distance2(atLeast(dx * dx + dy * dy + dz * dz, kLeastDistance2)),
          receiver(positivePart(dx * surface.normal.x + dy * surface.normal.y + dz * surface.normal.z)),
          light(positivePart(-(dx * quad.nx + dy * quad.ny + dz * quad.nz)))
    {
    }
};

/// w_G of Eq. 5: a joint bilateral weight of depth and normal, Gaussian in both.
float geometricWeight(const GBuffer& g, std::size_t pixel, std::size_t neighbour)
{
    const float depth = (g.depthLinear.texels[neighbour] / g.depthLinear.texels[pixel] - 1.0f) / kGeometricDepth;
    const float normal = (1.0f - glm::dot(g.normal.texels[pixel], g.normal.texels[neighbour])) / kGeometricNormal;
    return fastExp2(-0.5f * kLog2E * (depth * depth + normal * normal));
}

/// The covered block nearest to a place; rows from the top, columns from the left of equals.
bool findNearest(const GBuffer& g, const Blocks& blocks, int column, int row, std::size_t& block)
{
    int nearest = kSearchedBlocks * kSearchedBlocks * 2 + 1;
    for (int j = std::max(0, row - kSearchedBlocks); j <= std::min(blocks.rows() - 1, row + kSearchedBlocks); ++j)
        for (int i = std::max(0, column - kSearchedBlocks); i <= std::min(blocks.columns() - 1, column + kSearchedBlocks); ++i) {
            const int away = (i - column) * (i - column) + (j - row) * (j - row);
            if (away >= nearest || !g.covered(blocks.pixel(i, j))) continue;
            nearest = away;
            block = std::size_t(j) * std::size_t(blocks.columns()) + std::size_t(i);
        }
    return nearest <= kSearchedBlocks * kSearchedBlocks * 2;
}

/// What the tiles count.
struct GatherCounts {
    std::uint64_t pixels = 0, cells = 0, proxies = 0;
    GatherCounts& operator+=(const GatherCounts& other)
    {
        pixels += other.pixels;
        cells += other.cells;
        proxies += other.proxies;
        return *this;
    }
};

/// What blocks have, by their lists' weights.
float blendOf(const std::vector<float>& values, const ListWeights& weights)
{
    float sum = 0.0f;
    for (std::size_t k = 0; k < 4; ++k)
        if (weights.weight[k] > 0.0f) sum += weights.weight[k] * values[weights.block[k]];
    return sum;
}

/// Eq. 7's sum over what is listed, over its own weights and times the part of the lobe that meets anything; or over the whole lobe's.
Vec3 specularOf(const GatherWorld& world, const ListWeights& weights, LitSurface surface, std::size_t pixel)
{
    surface.mirror = glm::normalize(mirrorDirection(surface.normal, glm::normalize(directionToEye(world.camera, surface.position))));
    if (!(glm::dot(surface.mirror, world.gbuffer.geometricNormal.texels[pixel]) > 0.0f)) return Vec3(0.0f);
    const float roughness = world.gbuffer.roughness.texels[pixel];
    const VplLobeWeight lobe(world.vpl, phongExponent(roughness));
    // Counts of rays are no measure of what fills the whole lobe.
    const bool byLobe = world.settings.lobeNorm == ProxyLobeNorm::lobe;
    const WeighedProxies* seen = byLobe ? nullptr : world.seen;
    LobeSum sum;
    forListedCells(world.lists, weights, [&](std::uint32_t cell, float weight, float) {
        const CellLight& light = seen ? seen->lights[cell] : world.cells.lights[cell];
        const LobeSum own = isNear(world, cell, surface.position) ? lobeByProxies(world.cells, seen, cell, surface, world.vpl, lobe)
                                                                  : lobeByHarmonics(light, world.cells.area, surface, world.vpl, lobe);
        sum.radiance += weight * own.radiance;
        sum.weight += weight * own.weight;
    });
    if (byLobe) return sum.radiance / ((*world.lobe)(roughness)*world.cells.preExposure);
    if (!(sum.weight > 0.0f)) return Vec3(0.0f);
    // Where the lobe looks out of the scene there is nothing to see.
    return sum.radiance * (blendOf(world.lists.lobeOpacity, weights) / (sum.weight * world.cells.preExposure));
}

}  // namespace

ListWeights listWeights(const GBuffer& gbuffer, int divisor, int x, int y)
{
    const Blocks blocks{gbuffer.width, gbuffer.height, divisor};
    const Between across = between(blocks, x, blocks.columns(), blocks.width), down = between(blocks, y, blocks.rows(), blocks.height);
    const std::size_t here = gbuffer.position.index(x, y);
    ListWeights found;
    float sum = 0.0f, mostLinear = 0.0f;
    std::size_t best = 4;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const bool right = (corner & 1) != 0, below = (corner & 2) != 0;
        const int column = right ? across.second : across.first, row = below ? down.second : down.first;
        const float linear = (right ? across.fraction : 1.0f - across.fraction) * (below ? down.fraction : 1.0f - down.fraction);
        const std::size_t there = blocks.pixel(column, row);
        found.block[corner] = std::size_t(row) * std::size_t(blocks.columns()) + std::size_t(column);
        if (!(linear > 0.0f) || !gbuffer.covered(there)) continue;
        found.weight[corner] = linear * geometricWeight(gbuffer, here, there);
        sum += found.weight[corner];
        if (linear > mostLinear) {
            mostLinear = linear;
            best = corner;
        }
    }
    if (sum > kLeastListWeight) {
        for (float& weight : found.weight) weight /= sum;
        return found;
    }
    found.weight = {};
    if (best < 4)
        found.weight[best] = 1.0f;
    else if (findNearest(gbuffer, blocks, across.first, down.first, found.block[0]))
        found.weight[0] = 1.0f;
    return found;
}

WholeCell cellByProxies(const ProxyCells& cells, const WeighedProxies* seen, std::uint32_t cell, std::uint32_t end, const LitSurface& surface,
                        const VplSettings& vpl)
{
    const VplNear near = vplNear(vpl, cells.area);
    Float4 red{}, green{}, blue{}, all{};
    for (std::uint32_t q = cells.first[cell]; q < end; ++q) {
        const ProxyQuad& quad = cells.quads[q];
        const QuadView view(quad, surface);
        Float4 geometry = atMost(view.receiver * view.light / (view.distance2 * (view.distance2 + near.softening)), near.most);
        if (seen) geometry *= seen->counts[q];
        red += quad.red * geometry;
        green += quad.green * geometry;
        blue += quad.blue * geometry;
        all += geometry;
    }
    return {Vec3(sumOf(red), sumOf(green), sumOf(blue)) * cells.area, sumOf(all) * cells.area / kPi};
}

WholeCell cellByHarmonics(const CellLight& light, const LitSurface& surface, const VplSettings& vpl)
{
    if (!(light.litArea > 0.0f)) return {};
    const VplNear near = vplNear(vpl, light.litArea);
    const Vec3 toLight = light.centroid - surface.position;
    const float d2 = std::max(glm::dot(toLight, toLight), kLeastDistance2), distance = std::sqrt(d2);
    const float cosine = glm::dot(surface.normal, toLight) / distance;
    if (!(cosine > 0.0f)) return {};
    const Vec4 sums = light.intensity(-toLight / distance) * std::min(near.most, cosine / (d2 + near.softening));
    return {Vec3(sums), sums.w / kPi};
}

Vec3 irradianceOfSeen(const CellLight& light, const WholeCell& whole, float share)
{
    const Vec3 most = kPi * light.brightest;
    Vec3 mean(0.0f);
    for (int c = 0; c < 3; ++c) {
        if (!(whole.irradiance[c] > 0.0f)) continue;
        mean[c] = whole.irradiance[c] < most[c] * whole.formFactor ? whole.irradiance[c] / whole.formFactor : most[c];
    }
    return share * mean;
}

LobeSum lobeByProxies(const ProxyCells& cells, const WeighedProxies* seen, std::uint32_t cell, const LitSurface& surface, const VplSettings& vpl,
                      const VplLobeWeight& lobe)
{
    const VplNear near = vplNear(vpl, cells.area);
    Float4 red{}, green{}, blue{}, weights{};
    for (std::uint32_t q = cells.first[cell]; q < cells.first[cell + 1]; ++q) {
        const ProxyQuad& quad = cells.quads[q];
        const QuadView view(quad, surface);
        const Float4 towards = positivePart(view.dx * surface.mirror.x + view.dy * surface.mirror.y + view.dz * surface.mirror.z);
        const Float4 cosine2 = towards * towards / view.distance2;
        Float4 weight{};
        for (int k = 0; k < 4; ++k)
            if (view.receiver[k] > 0.0f && view.light[k] > 0.0f) weight[k] = lobe.ofSquare(cosine2[k]) / std::sqrt(view.distance2[k]);
        Float4 share = weight * atMost(view.light / (view.distance2 + near.softening), near.most);
        if (seen) share *= seen->counts[q];
        red += quad.red * share;
        green += quad.green * share;
        blue += quad.blue * share;
        weights += share;
    }
    return {Vec3(sumOf(red), sumOf(green), sumOf(blue)) * cells.area, sumOf(weights) * cells.area};
}

LobeSum lobeByHarmonics(const CellLight& light, float area, const LitSurface& surface, const VplSettings& vpl, const VplLobeWeight& lobe)
{
    const VplNear near = vplNear(vpl, std::max(light.litArea, area));
    const Vec3 toLight = light.centroid - surface.position;
    const float d2 = std::max(glm::dot(toLight, toLight), kLeastDistance2), distance = std::sqrt(d2);
    if (!(glm::dot(surface.normal, toLight) > 0.0f)) return {};
    const Vec4 sums = light.intensity(-toLight / distance) *
                      (lobe.ofCosine(glm::dot(surface.mirror, toLight) / distance) * std::min(near.most, 1.0f / (d2 + near.softening)));
    return {Vec3(sums), sums.w};
}

Vec3 irradianceOfListed(const GatherWorld& world, std::uint32_t cell, const WholeCell& whole, float weight, float share)
{
    return world.settings.cellWeight == ProxyCellWeight::seen ? irradianceOfSeen(world.light(cell), whole, share) : whole.irradiance * weight;
}

ProxyPixel gatherProxyPixel(const GatherWorld& world, bool specular, int x, int y)
{
    const ProxyCells& cells = world.cells;
    const std::size_t pixel = world.gbuffer.position.index(x, y);
    const LitSurface surface{.position = world.gbuffer.position.texels[pixel], .normal = world.gbuffer.normal.texels[pixel]};
    const ListWeights weights = listWeights(world.gbuffer, world.lists.divisor, x, y);

    // Eq. 5 and 6.
    ProxyPixel out;
    const bool bySeen = world.settings.cellWeight == ProxyCellWeight::seen;
    forListedCells(world.lists, weights, [&](std::uint32_t cell, float weight, float share) {
        if (!(world.light(cell).litArea > 0.0f) || (bySeen && !(share > 0.0f))) return;
        const bool near = isNear(world, cell, surface.position);
        const std::uint32_t end = bySeen ? cells.first[cell + 1] : cells.litEnd[cell];
        const WholeCell whole = near ? cellByProxies(cells, world.seen, cell, end, surface, world.vpl) : cellByHarmonics(world.light(cell), surface, world.vpl);
        out.irradiance += irradianceOfListed(world, cell, whole, weight, share);
        ++out.cells;
        if (near) out.proxies += 4 * (end - cells.first[cell]);
    });
    out.irradiance /= cells.preExposure;
    out.opacity = blendOf(world.lists.opacity, weights);

    if (specular && world.gbuffer.specularColor.texels[pixel] != Vec3(0.0f)) out.specular = specularOf(world, weights, surface, pixel);
    return out;
}

Gathered gatherFromCells(const GatherWorld& world, const ReducedGBuffer& reduced, const Requirements& needs)
{
    const GBuffer& few = reduced.gbuffer;
    Gathered out = emptyGathered(few, needs);
    const GatherCounts counts = forTiles<GatherCounts>(few.width, few.height, [&] {
        return [&](int tileX, int tileY, GatherCounts& tile) {
            forPixels(few.width, few.height, tileX, tileY, [&](int column, int row) {
                const std::size_t at = out.irradiance.index(column, row);
                if (!few.covered(at)) return;
                const auto pixel = static_cast<int>(reduced.source[at]);
                const ProxyPixel light = gatherProxyPixel(world, needs.specular, pixel % world.gbuffer.width, pixel / world.gbuffer.width);
                out.irradiance.texels[at] = light.irradiance;
                out.opacity.texels[at] = light.opacity;
                if (needs.specular) out.specular.texels[at] = light.specular;
                ++tile.pixels;
                tile.cells += light.cells;
                tile.proxies += light.proxies;
            });
        };
    });
    out.counters = {{"gathered_pixels", double(counts.pixels)}, {"cells_evaluated", double(counts.cells)}, {"proxies_evaluated", double(counts.proxies)}};
    return out;
}

}  // namespace lrsm
