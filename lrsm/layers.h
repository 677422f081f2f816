#pragma once

#include "core/settings/settings.h"
#include "lrsm/rsm.h"

#include <vector>

namespace lrsm {

/// Depth range (linear depth of the light, [0, 1] over the scene) and <n.l> range of one layer. Half-open, the last closed.
struct LayerRange {
    float depthMin = 0.0f;                        ///< where the layer's stored texels begin: zMin_l of Eq. 15, overlap included
    float depthMax = 1.0f;                        ///< zMax_l
    float delta = 0.0f;                           ///< width of the overlap at either end, in linear depth
    bool decayAtMin = false, decayAtMax = false;  ///< does Eq. 15 fall off at that end?
    float nDotLMin = 0.0f;
    float nDotLMax = 1.0f;
    bool operator==(const LayerRange&) const = default;
};

/// One LRSM texel: Table 1's three textures, in the values the storage holds. Premultiplied by the layer's coverage.
struct alignas(16) LrsmTexel {
    float radiance[4] = {};  ///< A R (rgb), unused
    float normal[4] = {};    ///< alpha n, alpha (half)
    float depth[4] = {};     ///< alpha z, alpha z^2 (z warped to [0, 1] in the layer's range), alpha (UNORM16), unused
};

/// Layered reflective shadow map of one light: every layer's full mip chain.
struct Lrsm {
    LightProjection projection;
    float preExposure = 1.0f;              ///< the RSM's: what all radiance here is multiplied by
    int baseResolution = 1;                ///< half the RSM's
    std::vector<LayerRange> ranges;        ///< of the layers kept
    std::vector<std::size_t> levelOffset;  ///< first texel of each level within a layer
    std::size_t texelsPerLayer = 0;
    std::vector<LrsmTexel> texels;                   ///< layer-major
    std::vector<std::uint64_t> validTexelsPerLayer;  ///< RSM texels assigned to each layer kept
    int layersAsked = 0;                             ///< before empty ones were dropped
    std::uint64_t negativeVariances = 0;             ///< mip texels whose z^2 - z*z came out below 0, counted before any floor
    ConversionCounts conversions;

    int levels() const { return int(levelOffset.size()); }
    int layers() const { return int(ranges.size()); }
    int resolutionAt(int level) const { return baseResolution >> level; }
    const LrsmTexel* level(int layer, int lod) const { return texels.data() + std::size_t(layer) * texelsPerLayer + levelOffset[std::size_t(lod)]; }
    static constexpr std::size_t kGpuTexelBytes = 24;  ///< in Table 1's formats
};

template <class Visit>
void forEachArray(const Lrsm& lrsm, Visit&& visit)
{
    visit(lrsm.texels, ArrayTraits{lrsm.texels.size() * Lrsm::kGpuTexelBytes});
}

/// Layers asked for and kept, each kept layer's ranges and texels, and what was saturated, NaN, or came out with a negative variance.
Counters countersOf(const Lrsm& lrsm);

/// Bytes that a layer of an LRSM for this RSM resolution holds (x layers kept = byteSize).
std::size_t predictLayerBytes(int rsmResolution);

/// The (a+1)(b+1) ranges for this RSM (Sec. 4.3), empty layers included; nearest depth slice first, the <n.l> slices of one together.
/// Neighbouring depth ranges overlap by exactly delta, centred on the cut between equal slices. Without an overlap (or where a slice is so
/// thin that delta rounds to 0) they are a partition. A range is never thinner than 2^-16 / depthLayers, even if all depths are equal.
/// Edges are within kPartitionMaxError of where equal slices put them: whole ULPs of the far end keep overlaps exact.
inline constexpr float kPartitionMaxError = 2.5e-7f;
std::vector<LayerRange> partition(const Rsm& rsm, const LayerSettings& settings);

/// Each 2x2 RSM block merges per layer into the base level; full mip chains follow (2x2 box in float32, fixed order, converted per level).
/// In float32 storage every texel is the mean over the RSM's texels below it, within kRadianceMeanMaxError of the largest radiance and
/// kLayerNormalMaxError, kLayerDepthMaxError of 1; alpha is exact, and the layers of a partition sum to the map's mean within kLayerSumMaxError of it.
inline constexpr float kRadianceMeanMaxError = 1e-7f, kLayerNormalMaxError = 1.2e-7f, kLayerDepthMaxError = 2.5e-7f, kLayerSumMaxError = 1.2e-7f;
Lrsm buildLrsm(const Rsm& rsm, const LayerSettings& settings);

/// The same with ranges that are given instead of being fitted to this RSM: all of `partition`, of which those with a true `keep` are stored.
/// For checking another program's LRSM, which goes by the ranges it was told.
Lrsm buildLrsm(const Rsm& rsm, const LayerSettings& settings, const std::vector<LayerRange>& ranges, const std::vector<bool>& keep);

/// Layers that buildLrsm (the first) keeps, without building them: all of `partition`, or where empty ones are dropped, those with a lit texel.
int countLayers(const Rsm& rsm, const LayerSettings& settings);

/// Makes `level` (>= 1) of all layers anew from the level below as it is stored.
void filterLevel(Lrsm& lrsm, int level, const LayerSettings& settings);

/// Linear depth -> the layer's own [0, 1], in which its z and z^2 are stored. Widths (radii) scale by 1 / (depthMax - depthMin).
inline float warpDepth(const LayerRange& range, float z)
{
    return (z - range.depthMin) / (range.depthMax - range.depthMin);
}

/// Does the layer's depth interval meet [zc - r, zc + r]?
inline bool touches(const LayerRange& range, float zc, float r)
{
    return range.depthMin <= zc + r && range.depthMax >= zc - r;
}

/// Eq. 15: f(z_c) with smoothstep k, clamped to [0, 1]; 0 outside the range, 1 at an end that does not decay. Error <= kDecayMaxError; summed over
/// the ranges of partition() it is 1 within kDecaySumMaxError.
inline constexpr float kDecayMaxError = 3e-7f, kDecaySumMaxError = 3e-7f;
float decay(const LayerRange& range, float zc);

}  // namespace lrsm
