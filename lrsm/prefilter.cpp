// Sec. 4.2, 4.3 and 5 of Sugihara, Rauwendaal, Salvi: Layered Reflective Shadow Maps for Voxel-based Indirect Illumination, HPG 2014.
#include "core/base/memory.h"
#include "core/base/parallel.h"
#include "lrsm/layers.h"
#include "lrsm/sample.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace lrsm {
namespace {

constexpr int kTile = 32;  ///< edge, in base texels, of the square that one task merges and filters while it is in cache
constexpr int kNotKept = -1;

/// Which layers an RSM texel belongs to. Comparisons with the inner ends alone decide, so no rounding can open a gap.
class Classifier {
  public:
    Classifier(const std::vector<LayerRange>& all, int normalSlices) : normalSlices_(normalSlices)
    {
        const auto stride = static_cast<std::size_t>(normalSlices);
        for (std::size_t i = 0; i + stride < all.size(); i += stride) {
            upper_.push_back(all[i].depthMax);
            lower_.push_back(all[i + stride].depthMin);
        }
        for (std::size_t n = 1; n < stride; ++n) normalCuts_.push_back(all[n].nDotLMin);
    }

    /// Layers first, first + normalSlices, ... last: more than one only where depth slices overlap.
    struct Layers {
        int first = 0, last = -1;
    };
    Layers operator()(const RsmTexel& texel, float depth) const
    {
        if (!(texel.coverage > 0.0f)) return {};
        const int n = countReached(normalCuts_, texel.nDotL);
        return {countReached(upper_, depth) * normalSlices_ + n, countReached(lower_, depth) * normalSlices_ + n};
    }
    int stride() const { return normalSlices_; }

  private:
    static int countReached(const std::vector<float>& ascending, float value)
    {
        int count = 0;
        for (const float bound : ascending) count += value >= bound ? 1 : 0;
        return count;
    }

    std::vector<float> upper_, lower_;  ///< of depth slice i, and of slice i + 1
    std::vector<float> normalCuts_;
    int normalSlices_;
};

/// RSM texels in each layer asked for: valid ones, and those of them that send any light.
struct TexelCounts {
    std::uint64_t valid = 0, lit = 0;
};

std::vector<TexelCounts> countTexels(const Rsm& rsm, const Classifier& layersOf, std::size_t layers)
{
    constexpr std::size_t kRows = 64;
    const auto width = static_cast<std::size_t>(rsm.texels.width), height = static_cast<std::size_t>(rsm.texels.height);
    std::vector<std::vector<TexelCounts>> chunks((height + kRows - 1) / kRows, std::vector<TexelCounts>(layers));
    parallelFor(height, kRows, [&](std::size_t begin, std::size_t end) {
        auto& counts = chunks[begin / kRows];
        for (std::size_t i = begin * width; i < end * width; ++i) {
            const Classifier::Layers in = layersOf(rsm.texels.texels[i], rsm.depthLinear.texels[i]);
            const bool lit = rsm.texels.texels[i].radiance != Vec3(0.0f);
            for (int layer = in.first; layer <= in.last; layer += layersOf.stride()) {
                TexelCounts& count = counts[static_cast<std::size_t>(layer)];
                ++count.valid;
                count.lit += lit ? 1 : 0;
            }
        }
    });
    std::vector<TexelCounts> total(layers);
    for (const auto& counts : chunks)
        for (std::size_t layer = 0; layer < layers; ++layer) {
            total[layer].valid += counts[layer].valid;
            total[layer].lit += counts[layer].lit;
        }
    return total;
}

/// What a task counts beside its texels.
struct Tally {
    ConversionCounts conversions;
    std::uint64_t negativeVariances = 0;
};

/// An LRSM texel in float32, before its conversion.
struct WideTexel {
    Float4 radiance = {}, normal = {}, depth = {};
};

bool empty(const WideTexel& t)
{
    return t.depth[2] == 0.0f && t.normal[3] == 0.0f && t.radiance[0] == 0.0f && t.radiance[1] == 0.0f && t.radiance[2] == 0.0f;
}

/// 2x2 box: pairs first, so that four equal values give exactly that value.
WideTexel box(const WideTexel (&t)[4])
{
    const auto mean = [](Float4 a, Float4 b, Float4 c, Float4 d) { return 0.25f * ((a + b) + (c + d)); };
    return {mean(t[0].radiance, t[1].radiance, t[2].radiance, t[3].radiance), mean(t[0].normal, t[1].normal, t[2].normal, t[3].normal),
            mean(t[0].depth, t[1].depth, t[2].depth, t[3].depth)};
}

/// Builds levels of all layers kept, tile by tile.
class Prefilter {
  public:
    Prefilter(const Rsm& rsm, const LayerSettings& settings, const Classifier& layersOf, const std::vector<int>& keptIndex, Lrsm& lrsm)
        : rsm_(rsm), settings_(settings), layersOf_(layersOf), keptIndex_(keptIndex), lrsm_(lrsm)
    {
    }

    /// Base level of the tile at (x0, y0), then its own mips down to one texel.
    Tally tile(int x0, int y0, int edge, int edgeLevel) const
    {
        Tally tally;
        std::vector<std::uint8_t> present(static_cast<std::size_t>(lrsm_.layers()), 0);
        for (int y = y0; y < y0 + edge; ++y)
            for (int x = x0; x < x0 + edge; ++x) mergeBlock(x, y, present, tally);
        for (int layer = 0; layer < lrsm_.layers(); ++layer)
            if (present[static_cast<std::size_t>(layer)])
                for (int lod = 1; lod <= edgeLevel; ++lod) mipSquare(layer, lod, x0 >> lod, y0 >> lod, edge >> lod, tally);
        return tally;
    }

    /// Texels [x0, x0 + edge) x [y0, y0 + edge) of one level, from the level below.
    void mipSquare(int layer, int lod, int x0, int y0, int edge, Tally& tally) const
    {
        const int childResolution = lrsm_.resolutionAt(lod - 1);
        const LrsmTexel* children = lrsm_.level(layer, lod - 1);
        for (int y = y0; y < y0 + edge; ++y)
            for (int x = x0; x < x0 + edge; ++x) {
                const LrsmTexel* row = children + std::size_t(2 * y) * std::size_t(childResolution) + std::size_t(2 * x);
                const LrsmTexel* const four[4] = {row, row + 1, row + childResolution, row + childResolution + 1};
                WideTexel wide[4];
                for (int i = 0; i < 4; ++i) wide[i] = {loadFloat4(four[i]->radiance), loadFloat4(four[i]->normal), loadFloat4(four[i]->depth)};
                store(layer, lod, x, y, box(wide), tally);
            }
    }

  private:
    /// One 2x2 block of RSM texels into the base level: once for each layer that holds one of the four.
    void mergeBlock(int x, int y, std::vector<std::uint8_t>& present, Tally& tally) const
    {
        std::size_t index[4];
        Classifier::Layers in[4];
        for (int i = 0; i < 4; ++i) {
            index[i] = rsm_.texels.index(2 * x + (i & 1), 2 * y + (i >> 1));
            in[i] = layersOf_(rsm_.texels.texels[index[i]], rsm_.depthLinear.texels[index[i]]);
        }
        const auto holds = [&](int i, int layer) { return layer >= in[i].first && layer <= in[i].last && (layer - in[i].first) % layersOf_.stride() == 0; };
        for (int i = 0; i < 4; ++i)
            for (int layer = in[i].first; layer <= in[i].last; layer += layersOf_.stride()) {
                bool done = false;
                for (int before = 0; before < i; ++before) done = done || holds(before, layer);
                if (done) continue;
                const int kept = keptIndex_[static_cast<std::size_t>(layer)];
                if (kept == kNotKept) continue;
                WideTexel wide[4];
                for (int j = i; j < 4; ++j)
                    if (holds(j, layer)) wide[j] = texelOf(index[j], lrsm_.ranges[static_cast<std::size_t>(kept)]);
                store(kept, 0, x, y, box(wide), tally);
                present[static_cast<std::size_t>(kept)] = 1;
            }
    }

    /// One RSM texel, its depth warped to the layer's range; alpha 1.
    WideTexel texelOf(std::size_t index, const LayerRange& range) const
    {
        const RsmTexel& texel = rsm_.texels.texels[index];
        const float z = warpDepth(range, rsm_.depthLinear.texels[index]);
        return {Float4{texel.radiance.x, texel.radiance.y, texel.radiance.z, 0.0f}, Float4{texel.normal.x, texel.normal.y, texel.normal.z, 1.0f},
                Float4{z, z * z, 1.0f, 0.0f}};
    }

    void store(int layer, int lod, int x, int y, const WideTexel& wide, Tally& tally) const
    {
        if (empty(wide)) return;  // stays zero
        LrsmTexel texel;
        storeFloat4(texel.radiance, wide.radiance);
        storeFloat4(texel.normal, wide.normal);
        storeFloat4(texel.depth, wide.depth);
        if (settings_.storage == Storage::gpu) {
            for (int c = 0; c < 3; ++c) texel.radiance[c] = roundToHalf(texel.radiance[c], settings_.halfRounding, tally.conversions);
            for (int c = 0; c < 4; ++c) texel.normal[c] = roundToHalf(texel.normal[c], settings_.halfRounding, tally.conversions);
            for (int c = 0; c < 3; ++c) texel.depth[c] = roundToUnorm16(texel.depth[c], tally.conversions);
        }
        FilteredTexel stored;
        stored.depth = texel.depth[0];
        stored.depthSquared = texel.depth[1];
        stored.depthAlpha = texel.depth[2];
        tally.negativeVariances += depthMoments(stored, -kInfinity).negative ? 1 : 0;

        const auto resolution = static_cast<std::size_t>(lrsm_.resolutionAt(lod));
        LrsmTexel* texels = lrsm_.texels.data() + static_cast<std::size_t>(layer) * lrsm_.texelsPerLayer + lrsm_.levelOffset[static_cast<std::size_t>(lod)];
        texels[static_cast<std::size_t>(y) * resolution + static_cast<std::size_t>(x)] = texel;
    }

    const Rsm& rsm_;
    const LayerSettings& settings_;
    const Classifier& layersOf_;
    const std::vector<int>& keptIndex_;
    Lrsm& lrsm_;
};

/// Offsets of the levels within a layer; returns the layer's texels.
std::size_t layOutLevels(int baseResolution, std::vector<std::size_t>& offsets)
{
    std::size_t total = 0;
    for (int resolution = baseResolution; resolution >= 1; resolution /= 2) {
        offsets.push_back(total);
        total += static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution);
    }
    return total;
}

void fillLevels(const Prefilter& prefilter, Lrsm& lrsm)
{
    const int edge = std::min(kTile, lrsm.baseResolution), across = lrsm.baseResolution / edge;
    int edgeLevel = 0;
    while ((edge >> edgeLevel) > 1) ++edgeLevel;

    std::vector<Tally> tallies(static_cast<std::size_t>(across) * static_cast<std::size_t>(across));
    parallelFor(tallies.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            tallies[i] = prefilter.tile(static_cast<int>(i) % across * edge, static_cast<int>(i) / across * edge, edge, edgeLevel);
    });
    // Above the tiles: a few thousand texels a layer.
    std::vector<Tally> tops(static_cast<std::size_t>(lrsm.layers()));
    parallelFor(tops.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t layer = begin; layer < end; ++layer)
            for (int lod = edgeLevel + 1; lod < lrsm.levels(); ++lod)
                prefilter.mipSquare(static_cast<int>(layer), lod, 0, 0, lrsm.resolutionAt(lod), tops[layer]);
    });
    tallies.insert(tallies.end(), tops.begin(), tops.end());
    for (const Tally& tally : tallies) {
        lrsm.conversions += tally.conversions;
        lrsm.negativeVariances += tally.negativeVariances;
    }
}

Lrsm buildLrsm(const Rsm& rsm, const LayerSettings& settings, const std::vector<LayerRange>& all, const std::vector<bool>& keep, const Classifier& layersOf,
               const std::vector<TexelCounts>& counts)
{
    Lrsm lrsm;
    lrsm.projection = rsm.projection;
    lrsm.preExposure = rsm.preExposure;
    lrsm.baseResolution = rsm.texels.width / 2;
    lrsm.layersAsked = static_cast<int>(all.size());
    std::vector<int> keptIndex(all.size(), kNotKept);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!keep[i]) continue;
        keptIndex[i] = lrsm.layers();
        lrsm.ranges.push_back(all[i]);
        lrsm.validTexelsPerLayer.push_back(counts[i].valid);
    }
    lrsm.texelsPerLayer = layOutLevels(lrsm.baseResolution, lrsm.levelOffset);
    requireMemory(lrsm.ranges.size() * lrsm.texelsPerLayer * sizeof(LrsmTexel), "layered reflective shadow map",
                  "lower rsm_resolution or the number of layers");
    lrsm.texels.resize(lrsm.ranges.size() * lrsm.texelsPerLayer);
    fillLevels(Prefilter(rsm, settings, layersOf, keptIndex, lrsm), lrsm);
    return lrsm;
}

/// What is known of the layers before any is built.
struct FittedLayers {
    std::vector<LayerRange> all;
    Classifier layersOf;
    std::vector<TexelCounts> counts;
    std::vector<bool> keep;
};

FittedLayers fitLayers(const Rsm& rsm, const LayerSettings& settings)
{
    assert(settings.depthLayers >= 1 && settings.normalLayers >= 1 && settings.overlap >= 0.0f);
    const std::vector<LayerRange> all = partition(rsm, settings);
    const Classifier layersOf(all, std::max(settings.normalLayers, 1));
    FittedLayers fitted{.all = all, .layersOf = layersOf, .counts = countTexels(rsm, layersOf, all.size()), .keep = {}};
    for (const TexelCounts& count : fitted.counts) fitted.keep.push_back(!settings.dropEmpty || count.lit > 0);
    return fitted;
}

}  // namespace

std::size_t predictLayerBytes(int rsmResolution)
{
    std::vector<std::size_t> offsets;
    return layOutLevels(rsmResolution / 2, offsets) * sizeof(LrsmTexel);
}

Lrsm buildLrsm(const Rsm& rsm, const LayerSettings& settings)
{
    const FittedLayers fitted = fitLayers(rsm, settings);
    return buildLrsm(rsm, settings, fitted.all, fitted.keep, fitted.layersOf, fitted.counts);
}

int countLayers(const Rsm& rsm, const LayerSettings& settings)
{
    const std::vector<bool> keep = fitLayers(rsm, settings).keep;
    return static_cast<int>(std::count(keep.begin(), keep.end(), true));
}

Lrsm buildLrsm(const Rsm& rsm, const LayerSettings& settings, const std::vector<LayerRange>& ranges, const std::vector<bool>& keep)
{
    assert(ranges.size() == keep.size());
    const Classifier layersOf(ranges, std::max(settings.normalLayers, 1));
    return buildLrsm(rsm, settings, ranges, keep, layersOf, countTexels(rsm, layersOf, ranges.size()));
}

void filterLevel(Lrsm& lrsm, int level, const LayerSettings& settings)
{
    assert(level >= 1 && level < lrsm.levels());
    const auto resolution = static_cast<std::size_t>(lrsm.resolutionAt(level));
    for (int layer = 0; layer < lrsm.layers(); ++layer) {
        LrsmTexel* texels = lrsm.texels.data() + static_cast<std::size_t>(layer) * lrsm.texelsPerLayer + lrsm.levelOffset[static_cast<std::size_t>(level)];
        std::fill(texels, texels + resolution * resolution, LrsmTexel{});
    }
    const Rsm none;
    const Classifier noLayers({}, 1);
    const std::vector<int> noIndex;
    const Prefilter prefilter(none, settings, noLayers, noIndex, lrsm);
    Tally tally;
    for (int layer = 0; layer < lrsm.layers(); ++layer) prefilter.mipSquare(layer, level, 0, 0, lrsm.resolutionAt(level), tally);
}

}  // namespace lrsm
