#include "conetrace/frame/reduce.h"

#include "conetrace/frame/blocks.h"
#include "conetrace/frame/irradiance_filter.h"
#include "conetrace/frame/same_surface.h"
#include "conetrace/frame/tiles.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

namespace lrsm {
namespace {

/// The blocks that a pixel takes its light from: index (row * columns + column) and weight; the weights of those on other surfaces are 0.
struct BlockWeights {
    std::array<std::size_t, 4> block{};
    std::array<float, 4> weight{};
    float sum() const { return (weight[0] + weight[1]) + (weight[2] + weight[3]); }
};
BlockWeights blockWeights(const GBuffer& gbuffer, const Blocks& blocks, int x, int y)
{
    const Between across = between(blocks, x, blocks.columns(), blocks.width), down = between(blocks, y, blocks.rows(), blocks.height);
    const std::size_t here = gbuffer.position.index(x, y);
    BlockWeights found;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const bool right = (corner & 1) != 0, below = (corner & 2) != 0;
        const int column = right ? across.second : across.first, row = below ? down.second : down.first;
        found.block[corner] = std::size_t(row) * std::size_t(blocks.columns()) + std::size_t(column);
        const float bilinear = (right ? across.fraction : 1.0f - across.fraction) * (below ? down.fraction : 1.0f - down.fraction);
        const std::size_t there = blocks.pixel(column, row);
        if (bilinear > 0.0f && (there == here || sameSurface(gbuffer, here, there))) found.weight[corner] = bilinear;
    }
    return found;
}

template <class T>
void pick(const Image<T>& from, const std::vector<std::uint32_t>& source, int width, int height, Image<T>& to)
{
    if (from.empty()) return;
    to = Image<T>(width, height);
    for (std::size_t i = 0; i < source.size(); ++i) to.texels[i] = from.texels[source[i]];
}

/// Of a picture of the full size where `values` is one.
template <class T>
Image<T> fullSize(const Image<T>& values, const GBuffer& gbuffer)
{
    return values.empty() ? Image<T>() : Image<T>(gbuffer.width, gbuffer.height);
}

template <class T>
void blend(const Image<T>& values, const BlockWeights& weights, float total, std::size_t pixel, Image<T>& out)
{
    if (values.empty()) return;
    T sum{};
    for (std::size_t k = 0; k < 4; ++k)
        if (weights.weight[k] > 0.0f) sum += weights.weight[k] * values.texels[weights.block[k]];
    out.texels[pixel] = sum / total;
}

/// Pixels that stand alone have one rotation each: averaged with what is around them on their surface, blocks' pixels among it. `filter(values, x, y)`.
template <class Filter>
void filterAlone(Image<Vec3>& values, const ReducedGBuffer& reduced, const GBuffer& gbuffer, const Filter& filter)
{
    const std::size_t first = reduced.blockCount();
    std::vector<Vec3> filtered(reduced.source.size() - first);
    parallelFor(filtered.size(), std::size_t(kTile) * kTile, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const int pixel = static_cast<int>(reduced.source[first + i]);
            filtered[i] = filter(values, pixel % gbuffer.width, pixel / gbuffer.width);
        }
    });
    for (std::size_t i = 0; i < filtered.size(); ++i) values.texels[reduced.source[first + i]] = filtered[i];
}

}  // namespace

ReducedGBuffer everyPixel(const GBuffer& gbuffer)
{
    ReducedGBuffer all;
    all.gbuffer = gbuffer;
    all.blockRows = gbuffer.height;
    all.source.resize(gbuffer.objectId.texels.size());
    std::iota(all.source.begin(), all.source.end(), 0u);
    return all;
}

ReducedGBuffer reduceGBuffer(const GBuffer& gbuffer, int divisor)
{
    assert(divisor >= 2);
    const Blocks blocks{gbuffer.width, gbuffer.height, divisor};
    ReducedGBuffer out;
    out.divisor = divisor;
    out.blockRows = blocks.rows();

    // The blocks' pixels, in the picture's order.
    for (int row = 0; row < blocks.rows(); ++row)
        for (int column = 0; column < blocks.columns(); ++column) out.source.push_back(static_cast<std::uint32_t>(blocks.pixel(column, row)));

    // Pixels that stand alone, row by row.
    std::vector<std::vector<std::uint32_t>> alone(std::size_t(gbuffer.height));
    forCovered(gbuffer, [&](int x, int y) {
        if (blockWeights(gbuffer, blocks, x, y).sum() < kLeastBlockWeight)
            alone[std::size_t(y)].push_back(static_cast<std::uint32_t>(gbuffer.position.index(x, y)));
    });
    for (const std::vector<std::uint32_t>& row : alone) {
        out.source.insert(out.source.end(), row.begin(), row.end());
        out.alone += row.size();
    }

    // What is seen there.
    const int width = blocks.columns(), height = static_cast<int>((out.source.size() + std::size_t(width) - 1) / std::size_t(width));
    GBuffer& to = out.gbuffer;
    to.width = width, to.height = height;
    pick(gbuffer.position, out.source, width, height, to.position);
    pick(gbuffer.geometricNormal, out.source, width, height, to.geometricNormal);
    pick(gbuffer.normal, out.source, width, height, to.normal);
    pick(gbuffer.albedo, out.source, width, height, to.albedo);
    pick(gbuffer.specularColor, out.source, width, height, to.specularColor);
    pick(gbuffer.roughness, out.source, width, height, to.roughness);
    pick(gbuffer.depthLinear, out.source, width, height, to.depthLinear);
    pick(gbuffer.objectId, out.source, width, height, to.objectId);
    return out;
}

Gathered upsample(const Gathered& light, const ReducedGBuffer& reduced, const GBuffer& gbuffer)
{
    const Blocks blocks{gbuffer.width, gbuffer.height, reduced.divisor};
    Gathered out;
    out.irradiance = fullSize(light.irradiance, gbuffer);
    out.specular = fullSize(light.specular, gbuffer);
    out.opacity = fullSize(light.opacity, gbuffer);

    // What blocks speak for.
    forCovered(gbuffer, [&](int x, int y) {
        const BlockWeights weights = blockWeights(gbuffer, blocks, x, y);
        const float total = weights.sum();
        if (total < kLeastBlockWeight) return;
        const std::size_t pixel = gbuffer.position.index(x, y);
        blend(light.irradiance, weights, total, pixel, out.irradiance);
        blend(light.specular, weights, total, pixel, out.specular);
        blend(light.opacity, weights, total, pixel, out.opacity);
    });

    // What stands alone.
    const auto copyAlone = [&](const auto& values, auto& to) {
        for (std::size_t i = reduced.blockCount(); i < reduced.source.size() && !values.empty(); ++i) to.texels[reduced.source[i]] = values.texels[i];
    };
    copyAlone(light.irradiance, out.irradiance);
    copyAlone(light.specular, out.specular);
    copyAlone(light.opacity, out.opacity);
    out.filter4x4 = light.filter4x4;
    if (!light.filter4x4) return out;
    filterAlone(out.irradiance, reduced, gbuffer,
                [&](const Image<Vec3>& irradiance, int x, int y) { return filterPixel(irradiance, gbuffer, gbuffer.height, x, y); });
    if (light.lobeWeight.empty()) return out;
    Image<float> lobeWeight(gbuffer.width, gbuffer.height, 1.0f);  // blocks have been averaged
    copyAlone(light.lobeWeight, lobeWeight);
    filterAlone(out.specular, reduced, gbuffer,
                [&](const Image<Vec3>& specular, int x, int y) { return filterSpecularPixel(specular, lobeWeight, gbuffer, gbuffer.height, x, y); });
    return out;
}

}  // namespace lrsm
