#pragma once

#include "core/base/math.h"
#include "core/base/simd.h"
#include "lrsm/layers.h"

/// The sampler of the LRSM, in two steps: where a footprint lies (once a light) and what a layer holds there (once a layer).
namespace lrsm {

/// What the pre-filtered texture of one layer holds at a footprint, after trilinear filtering; still premultiplied.
struct FilteredTexel {
    Vec3 radiance{0.0f};        ///< A R
    Vec3 normal{0.0f};          ///< alpha n
    float normalAlpha = 0.0f;   ///< alpha stored with the normal
    float depth = 0.0f;         ///< alpha z, warped
    float depthSquared = 0.0f;  ///< alpha z^2
    float depthAlpha = 0.0f;    ///< alpha stored with the depth
};

/// Texels and weights of one trilinear lookup, the same for every layer of an Lrsm. Weights of one level sum to 1 inside the map, to less
/// where the border (0) has a share; a tap on the border has weight 0 and stands on the nearest texel.
struct LrsmFootprint {
    std::uint32_t texel[8] = {};  ///< index within a layer
    float weight[8] = {};
    int taps = 0;  ///< 4 on a whole level, else 8
};

/// Bound on the error of one texel's weight with exact fractions (a map's edge is a power of two, so u n - 0.5 loses nothing that matters).
/// Fractions in 1/256 give exact products.
inline constexpr float kFootprintWeightMaxError = 2e-7f;

namespace detail {

/// floor for |x| < 2^31, without a library call.
inline int floorToInt(float x)
{
    const int truncated = static_cast<int>(x);
    return truncated - (x < static_cast<float>(truncated) ? 1 : 0);
}

/// One axis of a bilinear lookup: texel centres at +0.5, border 0.
struct AxisTaps {
    int texel[2] = {0, 0};
    float weight[2] = {0.0f, 0.0f};
};

inline AxisTaps axisTaps(float coordinate, int resolution, FilterFraction fraction)
{
    AxisTaps taps;
    const float x = coordinate * static_cast<float>(resolution) - 0.5f;
    if (!(x >= -1.0f && x <= static_cast<float>(resolution))) return taps;  // wholly on the border; NaN too

    int x0;
    float f;
    if (fraction == FilterFraction::fixed8) {
        const int fixed = floorToInt(x * 256.0f + 0.5f);  // D3D11.3 7.18.16: 8 bits of sub-texel precision
        x0 = fixed >> 8;
        f = static_cast<float>(fixed & 255) * (1.0f / 256.0f);
    } else {
        x0 = floorToInt(x);
        f = x - static_cast<float>(x0);
    }
    const int last = resolution - 1;
    taps.weight[0] = x0 >= 0 && x0 <= last ? 1.0f - f : 0.0f;
    taps.weight[1] = x0 + 1 <= last ? f : 0.0f;
    taps.texel[0] = std::min(std::max(x0, 0), last);
    taps.texel[1] = std::min(x0 + 1, last);
    return taps;
}

inline void addLevel(LrsmFootprint& footprint, const Lrsm& lrsm, float u, float v, int lod, float share, FilterFraction fraction)
{
    const int resolution = lrsm.resolutionAt(lod);
    const AxisTaps x = axisTaps(u, resolution, fraction), y = axisTaps(v, resolution, fraction);
    const auto offset = static_cast<std::uint32_t>(lrsm.levelOffset[static_cast<std::size_t>(lod)]);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const int tap = footprint.taps++;
            footprint.texel[tap] = offset + static_cast<std::uint32_t>(y.texel[j] * resolution + x.texel[i]);
            footprint.weight[tap] = (x.weight[i] * y.weight[j]) * share;
        }
}

/// Sum of weight times four floats at `part` of each tap's texel; pairs are added in a fixed tree.
inline Float4 filterPart(const LrsmTexel* layer, const LrsmFootprint& footprint, const float (LrsmTexel::*part)[4])
{
    const auto tap = [&](int i) { return footprint.weight[i] * loadFloat4(layer[footprint.texel[i]].*part); };
    const Float4 fine = (tap(0) + tap(1)) + (tap(2) + tap(3));
    if (footprint.taps == 4) return fine;
    return fine + ((tap(4) + tap(5)) + (tap(6) + tap(7)));
}

}  // namespace detail

/// GPU sampler's addressing: texel centres at +0.5, bilinear, trilinear between levels, border 0, level clamped to [0, last] (NaN: 0).
/// fixed8 rounds texel coordinates and level to 1/256. Any u, v; NaN or far outside gives weights of 0.
inline LrsmFootprint makeFootprint(const Lrsm& lrsm, float u, float v, float level, FilterFraction fraction)
{
    const auto last = static_cast<float>(lrsm.levels() - 1);
    float lod = level > 0.0f ? std::min(level, last) : 0.0f;
    if (fraction == FilterFraction::fixed8) lod = static_cast<float>(detail::floorToInt(lod * 256.0f + 0.5f)) * (1.0f / 256.0f);
    const int fine = static_cast<int>(lod);
    const float share = lod - static_cast<float>(fine);

    LrsmFootprint footprint;
    detail::addLevel(footprint, lrsm, u, v, fine, 1.0f - share, fraction);
    if (share > 0.0f) detail::addLevel(footprint, lrsm, u, v, fine + 1, share, fraction);
    return footprint;
}

/// True where every tap stands on the border, with weight 0: outside the map each layer holds exactly nothing. Most samples of a spot or of a
/// point light's six faces are there.
inline bool outsideMap(const LrsmFootprint& footprint)
{
    float weight = 0.0f;
    for (int tap = 0; tap < footprint.taps; ++tap) weight += footprint.weight[tap];
    return !(weight > 0.0f);
}

/// First texel of a layer, for the three lookups below.
inline const LrsmTexel* layerTexels(const Lrsm& lrsm, int layer)
{
    return lrsm.texels.data() + static_cast<std::size_t>(layer) * lrsm.texelsPerLayer;
}

/// Table 1's three textures, filtered: (alpha z, alpha z^2, alpha, -), (alpha n, alpha), (A R, -).
inline Float4 sampleDepth(const LrsmTexel* layer, const LrsmFootprint& footprint)
{
    return detail::filterPart(layer, footprint, &LrsmTexel::depth);
}
inline Float4 sampleNormal(const LrsmTexel* layer, const LrsmFootprint& footprint)
{
    return detail::filterPart(layer, footprint, &LrsmTexel::normal);
}
inline Float4 sampleRadiance(const LrsmTexel* layer, const LrsmFootprint& footprint)
{
    return detail::filterPart(layer, footprint, &LrsmTexel::radiance);
}

/// All three at once. Where alpha is 0 (in either texture) nothing else is read, and the result is all zeros: the layer is to be skipped.
inline FilteredTexel sampleLayer(const Lrsm& lrsm, int layer, const LrsmFootprint& footprint)
{
    const LrsmTexel* texels = layerTexels(lrsm, layer);
    const Float4 depth = sampleDepth(texels, footprint);
    if (!(depth[2] > 0.0f)) return {};
    const Float4 normal = sampleNormal(texels, footprint);
    if (!(normal[3] > 0.0f)) return {};
    const Float4 radiance = sampleRadiance(texels, footprint);
    return {.radiance = Vec3(radiance[0], radiance[1], radiance[2]),
            .normal = Vec3(normal[0], normal[1], normal[2]),
            .normalAlpha = normal[3],
            .depth = depth[0],
            .depthSquared = depth[1],
            .depthAlpha = depth[2]};
}

}  // namespace lrsm
